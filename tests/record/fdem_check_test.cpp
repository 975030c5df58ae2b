// Every rule of an FDEM record is broken on purpose, and must be the one that is named.
#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "common/record/check.hpp"
#include "common/record/content.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_fdem.hpp"

using namespace fracfarm;

namespace {

using Names = std::set<std::string>;

Names broken(const std::vector<Check>& checks) {
  Names names;
  for (const Check& check : checks)
    if (!check.passed) names.insert(check.name);
  return names;
}

Names broken_by(const std::function<void(Record&)>& harm) {
  Record record = sample::fdem_record();
  harm(record);
  return broken(check_record_bytes(record_bytes(record).value()).checks);
}

// An edge that has a break time, one that never breaks, one of an initial crack.
std::size_t broken_edge(const Record& r) {
  const auto& times = r.fdem.break_time;
  return static_cast<std::size_t>(std::find_if(times.begin(), times.end(), [](double t) { return !std::isnan(t); }) - times.begin());
}
std::size_t whole_edge(const Record& r) {
  std::size_t e = 0;
  while (!std::isnan(r.fdem.break_time[e]) || r.fdem.mesh.edge_kind[e] == EdgeKind::crack) ++e;
  return e;
}
std::size_t crack_edge(const Record& r) {
  const auto& kinds = r.fdem.mesh.edge_kind;
  return static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), EdgeKind::crack) - kinds.begin());
}

double& at(Record& record, std::string_view name, std::size_t row) {
  for (Column& column : record.series.columns)
    if (column.name == name) return column.values[row];
  throw std::logic_error("no such column");
}

}  // namespace

TEST_CASE("a sound FDEM record breaks no rule and reads back as it was") {
  const Record sound = sample::fdem_record();
  const std::string bytes = record_bytes(sound).value();
  const CheckedRecord checked = check_record_bytes(bytes);
  for (const Check& check : checked.checks)
    if (!check.passed) UNSCOPED_INFO(check.name << ": " << check.detail << " " << check.value);
  CHECK(broken(checked.checks) == Names{});
  REQUIRE(checked.record);
  CHECK(checked.record->fdem.mesh == sound.fdem.mesh);
  CHECK(checked.record->fdem.break_mode == sound.fdem.break_mode);
  CHECK(checked.record->fdem.damage_failure == as_stored(sound).fdem.damage_failure);
  CHECK(record_bytes(*checked.record).value() == bytes);
  CHECK(sound.judgement.rule == "five_step");
  CHECK(sound.failure_times[0].time);
}

TEST_CASE("numbers of an FDEM record that are not finite are named") {
  CHECK(broken_by([](Record& r) { r.fdem.damage[3][whole_edge(r)] = std::nanf(""); }).contains("finite"));
  CHECK(broken_by([](Record& r) { r.fdem.break_time[broken_edge(r)] = INFINITY; }).contains("finite"));
  CHECK(broken_by([](Record& r) { r.fdem.mesh.nodes[5][0] = std::nan(""); }).contains("finite"));
  CHECK(broken_by([](Record& r) { at(r, "contact_energy", 7) = INFINITY; }).contains("finite"));
}

TEST_CASE("damage of a joint is in 0...1 or 2") {
  CHECK(broken_by([](Record& r) { r.fdem.damage.back()[whole_edge(r)] = 1.5f; }) == Names{"damage_range"});
  CHECK(broken_by([](Record& r) { r.fdem.damage_initial[whole_edge(r)] = -0.01f; }) == Names{"damage_range"});
  CHECK(broken_by([](Record& r) { r.fdem.damage.back()[whole_edge(r)] = 2.5f; }).contains("damage_range"));
}

TEST_CASE("joints that heal are named, however little") {
  CHECK(broken_by([](Record& r) { r.fdem.damage[5][whole_edge(r)] = 0.5f; }) == Names{"damage_growth"});
  CHECK(broken_by([](Record& r) {
          for (std::size_t t = 4; t < 9; ++t) r.fdem.damage[t][whole_edge(r)] = 0.5f;
          r.fdem.damage_failure[whole_edge(r)] = 0.5f;
          r.fdem.damage[8][whole_edge(r)] -= 2e-4f;
        }) == Names{"damage_growth"});
}

TEST_CASE("initial cracks are at 2 in every frame, and nothing else is") {
  CHECK(broken_by([](Record& r) { r.fdem.damage[0][crack_edge(r)] = 1.0f; }).contains("cracks_held"));
  CHECK(broken_by([](Record& r) { r.fdem.damage_failure[crack_edge(r)] = 0.5f; }).contains("cracks_held"));
  CHECK(broken_by([](Record& r) { r.fdem.damage.back()[whole_edge(r)] = 2.0f; }) == Names{"cracks_held"});
  CHECK(broken_by([](Record& r) { r.fdem.mesh.edge_kind[whole_edge(r)] = EdgeKind::crack; }).contains("cracks_held"));
  CHECK(broken_by([](Record& r) { r.fdem.mesh.edge_kind[whole_edge(r)] = static_cast<EdgeKind>(7); }).contains("cracks_held"));
}

TEST_CASE("an edge is at 1 from its break time on and not before") {
  CHECK(broken_by([](Record& r) { r.fdem.break_time[broken_edge(r)] = 2.9e-4; }).contains("break_times"));
  CHECK(broken_by([](Record& r) { r.fdem.break_time[broken_edge(r)] = std::nan(""); }).contains("break_times"));
  CHECK(broken_by([](Record& r) { r.fdem.break_time[whole_edge(r)] = 2e-4; }).contains("break_times"));
  CHECK(broken_by([](Record& r) { r.fdem.damage.back()[whole_edge(r)] = 1.0f; }) == Names{"break_times"});
  CHECK(broken_by([](Record& r) { r.fdem.damage_failure[broken_edge(r)] = 0.999f; }).contains("break_times"));
}

TEST_CASE("what breaks has a mode, within the run, and is no initial crack") {
  CHECK(broken_by([](Record& r) { r.fdem.break_mode[broken_edge(r)] = 0; }) == Names{"break_times"});
  CHECK(broken_by([](Record& r) { r.fdem.break_mode[broken_edge(r)] = 4; }) == Names{"break_times"});
  CHECK(broken_by([](Record& r) { r.fdem.break_mode[whole_edge(r)] = 1; }) == Names{"break_times"});
  CHECK(
      broken_by([](Record& r) { r.fdem.break_time[crack_edge(r)] = 1e-4, r.fdem.break_mode[crack_edge(r)] = 1; }).contains("break_times"));
  CHECK(broken_by([](Record& r) { r.fdem.break_time[broken_edge(r)] = -1e-4; }).contains("break_times"));
  CHECK(broken_by([](Record& r) {  // after the last frame and row
          r.fdem.break_time[whole_edge(r)] = 4e-4, r.fdem.break_mode[whole_edge(r)] = 1;
        }) == Names{"break_times"});
}

TEST_CASE("a joint near 1 is not stored as broken") {
  Record record = sample::fdem_record();
  const std::size_t edge = whole_edge(record);
  for (std::size_t t = 5; t < record.fdem.damage.size(); ++t) record.fdem.damage[t][edge] = 0.99999f;
  record.fdem.damage_failure[edge] = 0.0f;
  const CheckedRecord checked = check_record_bytes(record_bytes(record).value());
  CHECK_FALSE(broken(checked.checks).contains("break_times"));
  CHECK(checked.record->fdem.damage.back()[edge] == 1.0f - 1.0f / 8192.0f);
}

TEST_CASE("a mesh that is none of the scene's is named") {
  CHECK(broken_by([](Record& r) { r.fdem.mesh.nodes[0][0] -= 1e-4; }) == Names{"mesh_domain", "mesh_area", "mesh_edges"});
  CHECK(broken_by([](Record& r) { std::swap(r.fdem.mesh.triangles[9][0], r.fdem.mesh.triangles[9][1]); }).contains("mesh_triangles"));
  CHECK(broken_by([](Record& r) { r.fdem.mesh.nodes[30] = r.fdem.mesh.nodes[31]; }).contains("mesh_triangles"));
  CHECK(broken_by([](Record& r) {  // a triangle is missing: a hole, and edges of a triangle that is another now
          r.fdem.mesh.triangles[40] = r.fdem.mesh.triangles[41];
        })
            .contains("mesh_edges"));
}

TEST_CASE("edges that do not part the triangles they name are named") {
  CHECK(broken_by([](Record& r) { std::swap(r.fdem.mesh.edge_triangles[7][0], r.fdem.mesh.edge_triangles[7][1]); }) == Names{"mesh_edges"});
  CHECK(broken_by([](Record& r) { r.fdem.mesh.edge_triangles[7][0] ^= 2; }).contains("mesh_edges"));
  CHECK(broken_by([](Record& r) { r.fdem.mesh.edge_nodes[7] = r.fdem.mesh.edge_nodes[8]; }).contains("mesh_edges"));
  CHECK(broken_by([](Record& r) {  // one edge twice, another not at all
          r.fdem.mesh.edge_nodes[7] = r.fdem.mesh.edge_nodes[8], r.fdem.mesh.edge_triangles[7] = r.fdem.mesh.edge_triangles[8];
        }) == Names{"mesh_edges"});
}

TEST_CASE("cracks of the mesh lie where the scene has them, all of them") {
  const auto make_crack = [](Record& r, std::size_t e, bool crack) {
    r.fdem.mesh.edge_kind[e] = crack ? EdgeKind::crack : EdgeKind::joint;
    const float damage = crack ? 2.0f : 0.0f;
    for (auto& frame : r.fdem.damage) frame[e] = damage;
    r.fdem.damage_initial[e] = r.fdem.damage_failure[e] = damage;
  };
  CHECK(broken_by([&](Record& r) { make_crack(r, 2, true); }) == Names{"mesh_cracks"});
  CHECK(broken_by([&](Record& r) {
          for (std::size_t e = 0; e < r.fdem.mesh.edge_kind.size(); ++e)
            if (r.fdem.mesh.edge_kind[e] == EdgeKind::crack && sample::edge_at(r.fdem.mesh, e).x < 0.15) make_crack(r, e, false);
        }) == Names{"mesh_cracks"});
}

TEST_CASE("the series and the judgement of an FDEM record are held to each other") {
  CHECK(broken_by([](Record& r) { *r.failure_times[0].time += 1e-6; }).contains("drop10"));
  CHECK(broken_by([](Record& r) { r.failure_times[1].time.reset(); }).contains("five_step"));
  CHECK(broken_by([](Record& r) { r.failure_times.erase(r.failure_times.begin()); }).contains("drop10"));
  CHECK(broken_by([](Record& r) { r.judgement.rule = "drop10"; }).contains("judgement"));
  CHECK(broken_by([](Record& r) { r.peak_stress *= 1.5; }) == Names{"peak_stress"});
  CHECK(broken_by([](Record& r) { at(r, "friction_energy", 30) += 1e-3; }) == Names{"ledger_sum"});
  CHECK(broken_by([](Record& r) { at(r, "energy_residual", 60) += 5.0, at(r, "external_work", 60) -= 5.0; }) ==
        Names{"energy_closed", "energy_residual"});
  CHECK(broken_by([](Record& r) { at(r, "step_time", 5) = at(r, "step_time", 4); }).contains("series_times"));
  CHECK(broken_by([](Record& r) { std::swap(r.fdem.time[2], r.fdem.time[3]); }).contains("frame_times"));
}

TEST_CASE("identity of an FDEM record is the scene's") {
  CHECK(broken_by([](Record& r) { r.cracks[0].x0 += 1e-9; }) == Names{"scene"});
  CHECK(broken_by([](Record& r) { r.key[0] = r.key[0] == 'a' ? 'b' : 'a'; }) == Names{"key"});
  CHECK(broken_by([](Record& r) { r.canonical_scene = "{}"; }).contains("mesh_cracks"));
}

TEST_CASE("a body of which nothing broke has not failed, whatever its stress does") {
  Record record = sample::fdem_record();
  std::fill(record.fdem.break_time.begin(), record.fdem.break_time.end(), std::nan(""));
  std::fill(record.fdem.break_mode.begin(), record.fdem.break_mode.end(), 0);
  for (std::size_t t = 0; t < record.fdem.time.size(); ++t) record.fdem.damage[t] = sample::damage_at(record.fdem, record.fdem.time[t]);
  CHECK(broken(check_record_bytes(record_bytes(record).value()).checks).contains("five_step"));
  sample::judge_fdem(record);
  CHECK(record.judgement.verdict == Verdict::censored);
  CHECK(broken(check_record_bytes(record_bytes(record).value()).checks) == Names{});
}

TEST_CASE("meshes whose indices or sizes do not fit are refused before they are looked at") {
  const auto why = [](const std::function<void(FdemFrames&)>& harm) {
    Record record = sample::fdem_record();
    harm(record.fdem);
    const std::string said = broken_shape(record);
    CHECK_FALSE(record_bytes(record));
    return said;
  };
  CHECK(why([](FdemFrames& f) { f.mesh.triangles[3][1] = 1 << 30; }).find("a triangle on a node") == 0);
  CHECK(why([](FdemFrames& f) { f.mesh.triangles[3][1] = -1; }).find("a triangle on a node") == 0);
  CHECK(why([](FdemFrames& f) { f.mesh.edge_nodes[3][1] = 99999; }).find("an edge at a node") == 0);
  CHECK(why([](FdemFrames& f) { f.mesh.edge_triangles[3][1] = -7; }).find("an edge of a triangle") == 0);
  CHECK(why([](FdemFrames& f) { f.mesh.edge_kind.pop_back(); }).find("edges with") != std::string::npos);
  CHECK(why([](FdemFrames& f) { f.damage[2].pop_back(); }).find("a frame of") == 0);
  CHECK(why([](FdemFrames& f) { f.damage.pop_back(); }).find("frames of damage") != std::string::npos);
  CHECK(why([](FdemFrames& f) { f.break_mode.clear(); }).find("break_mode") != std::string::npos);
  CHECK(why([](FdemFrames& f) { f = {}; }).find("a mesh of 0 nodes") == 0);
}

TEST_CASE("a method that has no layout makes no record") {
  Record record = sample::fdem_record();
  record.method = "alchemy";
  CHECK(record_bytes(record).error().message.find("alchemy") != std::string::npos);
}
