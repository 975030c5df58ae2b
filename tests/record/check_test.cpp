// Every rule of the validator is broken on purpose, and must be the one that is named.
#include "common/record/check.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "common/record/seal.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

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
  Record record = sample::record();
  harm(record);
  return broken(check_record_bytes(record_bytes(record).value()).checks);
}

double& at(Record& record, std::string_view name, std::size_t row) {
  for (Column& column : record.series.columns)
    if (column.name == name) return column.values[row];
  throw std::logic_error("no such column");
}

}  // namespace

TEST_CASE("a sound record breaks no rule") {
  const CheckedRecord checked = check_record_bytes(record_bytes(sample::record()).value());
  CHECK(broken(checked.checks) == Names{});
  CHECK(checked.passed());
  CHECK(checked.record.value().key == sample::record().key);
}

TEST_CASE("numbers that are not finite are named") {
  CHECK(broken_by([](Record& r) { r.phase_field.psi[3][5] = std::nanf(""); }).contains("finite"));
  CHECK(broken_by([](Record& r) { at(r, "external_work", 7) = INFINITY; }).contains("finite"));
  CHECK(broken_by([](Record& r) { r.peak_stress = std::nan(""); }).contains("finite"));
}

TEST_CASE("damage outside 0...1 is named") {
  CHECK(broken_by([](Record& r) { r.phase_field.psi.back()[0] = -1e-3f; }) == Names{"damage_range", "damage_growth"});
  CHECK(broken_by([](Record& r) { r.phase_field.psi_failure[0] = 1.01f; }).contains("damage_range"));
}

TEST_CASE("damage that heals is named, in frames and at the failure") {
  CHECK(broken_by([](Record& r) { r.phase_field.psi[5][40] *= 0.9f; }) == Names{"damage_growth"});
  CHECK(broken_by([](Record& r) { r.phase_field.psi_failure[40] *= 0.9f; }) == Names{"damage_growth"});
  CHECK(
      broken_by([](Record& r) { r.phase_field.psi[0] = std::vector<float>(r.phase_field.psi[0].size(), 0.0f); }).contains("damage_growth"));
}

TEST_CASE("a drop within a unit of the stored resolution is not healing") {
  CHECK(broken_by([](Record& r) { r.phase_field.psi[5][40] -= 1e-4f; }) == Names{});
}

TEST_CASE("initial cracks that are not held at one are named") {
  CHECK(broken_by([](Record& r) { r.phase_field.mask_initial[3] = 1; }) == Names{"mask_held"});
  CHECK(broken_by([](Record& r) { r.phase_field.mask_initial[3] = 7; }) == Names{"mask_held"});
}

TEST_CASE("times out of order are named") {
  CHECK(broken_by([](Record& r) { std::swap(r.phase_field.time[2], r.phase_field.time[3]); }) == Names{"frame_times"});
  CHECK(broken_by([](Record& r) { r.phase_field.time[0] = 1e-7; }) == Names{"frame_times"});
  CHECK(broken_by([](Record& r) { at(r, "step_time", 5) = at(r, "step_time", 4); }) == Names{"series_times"});
}

TEST_CASE("frames past the horizon are named") {
  CHECK(broken_by([](Record& r) { r.phase_field.time.back() = 2e-3; }).contains("frame_times"));
}

TEST_CASE("a grid that is not the scene's is named") {
  CHECK(broken_by([](Record& r) { r.phase_field.x[4] += 1e-6; }) == Names{"grid"});
}

TEST_CASE("identity that is not the scene's is named") {
  CHECK(broken_by([](Record& r) { r.material = "steel"; }) == Names{"scene"});
  CHECK(broken_by([](Record& r) { r.sample_id = 12; }) == Names{"scene"});
  CHECK(broken_by([](Record& r) { r.boundary_condition = "biaxial"; }) == Names{"scene"});
  CHECK(broken_by([](Record& r) { r.cracks[0].x0 += 1e-9; }) == Names{"scene"});
}

TEST_CASE("a scene that is not canonical, or not a scene, is named") {
  CHECK(broken_by([](Record& r) {
          r.canonical_scene = " " + r.canonical_scene;
          r.key = job_key(r.canonical_scene, r.provenance["build_id"]);
        }) == Names{"scene"});
  CHECK(broken_by([](Record& r) { r.canonical_scene = "{}"; }).contains("scene"));
}

TEST_CASE("a key that is not the digest of scene and build is named") {
  CHECK(broken_by([](Record& r) { r.key[0] = r.key[0] == 'a' ? 'b' : 'a'; }) == Names{"key"});
  CHECK(broken_by([](Record& r) { r.provenance["build_id"] += "x"; }) == Names{"key"});
  CHECK(broken_by([](Record& r) { r.provenance.erase("build_id"); }) == Names{"key"});
}

TEST_CASE("the outcome of another build's rules is not held against a record") {
  Record record = sample::record();
  const auto checks_of = [](const Record& r) { return check_record_bytes(record_bytes(r).value()).checks; };
  record.provenance["build_id"] = "0.0.1-older";
  record.key = job_key(record.canonical_scene, "0.0.1-older");
  CHECK(broken(checks_of(record)) == Names{});
}

TEST_CASE("an energy ledger that is open, or whose sum is wrong, is named") {
  CHECK(broken_by([](Record& r) { r.energy_residual = 0.5; }) == Names{"energy_residual"});
  CHECK(broken_by([](Record& r) { at(r, "elastic_energy", 30) += 1e-3; }) == Names{"ledger_sum"});
  CHECK(broken_by([](Record& r) { at(r, "energy_residual", 30) += 5.0, at(r, "external_work", 30) -= 5.0; }) ==
        Names{"energy_closed", "energy_residual"});
}

TEST_CASE("only a quasi-static run may have an open ledger: nothing takes up the energy of an unstable jump") {
  const auto open = [](Integrator integrator) {
    return broken_by([&](Record& r) {
      Scene scene = sample::scene_of_size({});
      scene.phase_field.integrator = integrator;
      scene.phase_field.dt = 1e-7;
      r.canonical_scene = canonical_text(scene);
      r.key = job_key(r.canonical_scene, r.provenance["build_id"]);
      at(r, "energy_residual", 30) += 5.0, at(r, "external_work", 30) -= 5.0;
    });
  };
  CHECK(open(Integrator::explicit_central) == Names{"energy_closed", "energy_residual"});
  CHECK(open(Integrator::newmark) == Names{"energy_closed", "energy_residual"});
  CHECK(open(Integrator::quasi_static) == Names{"energy_residual"});
}

TEST_CASE("a peak that the series does not have is named") {
  CHECK(broken_by([](Record& r) { r.peak_stress *= 0.99; }) == Names{"peak_stress"});
  CHECK(broken_by([](Record& r) { r.peak_stress *= 1.5; }) == Names{"peak_stress"});
}

TEST_CASE("candidate times that the series do not give are named") {
  CHECK(broken_by([](Record& r) { *r.failure_times[1].time += 1e-6; }).contains("stress_drop"));
  CHECK(broken_by([](Record& r) { r.failure_times[1].time.reset(); }).contains("stress_drop"));
  CHECK(broken_by([](Record& r) { r.failure_times[2].time = 1e-5; }).contains("five_step"));
}

TEST_CASE("fields that contradict the through crack are named") {
  CHECK(broken_by([](Record& r) {  // said to be through, but the field is not
          r.phase_field.psi_failure = r.phase_field.psi[7];
          r.phase_field.psi.pop_back(), r.phase_field.time.pop_back();
        }) == Names{"through_crack"});
  CHECK(broken_by([](Record& r) {  // through in a frame before its time
          r.phase_field.psi[7] = r.phase_field.psi[8];
        }) == Names{"through_crack"});
  CHECK(broken_by([](Record& r) {  // through, but no time
          r.failure_times[0].time.reset();
          r.judgement = judge(r.method, r.failure_times, "horizon");
        })
            .contains("through_crack"));
}

TEST_CASE("a judgement that the candidates do not give is named") {
  CHECK(broken_by([](Record& r) { r.judgement.confidence = 0.99; }) == Names{"judgement"});
  CHECK(broken_by([](Record& r) { r.judgement.verdict = Verdict::censored; }) == Names{"judgement"});
  CHECK(broken_by([](Record& r) { r.judgement.rule = "stress_drop"; }).contains("judgement"));
}

TEST_CASE("a file that is cut off has no seal") {
  const std::string bytes = record_bytes(sample::record()).value();
  const CheckedRecord cut = check_record_bytes(bytes.substr(0, bytes.size() - seal_size));
  CHECK(broken(cut.checks) == Names{"complete", "grammar"});
  CHECK_FALSE(cut.record);
  CHECK_FALSE(read_record_bytes(bytes.substr(0, bytes.size() - seal_size)));
}

TEST_CASE("another job's record is named") {
  const std::string bytes = record_bytes(sample::record()).value();
  CHECK(broken(check_record_bytes(bytes, {sample::record().key}).checks) == Names{});
  CHECK(broken(check_record_bytes(bytes, {std::string(64, '0')}).checks) == Names{"expected_key"});
}

TEST_CASE("what is no record at all fails in words") {
  CHECK(broken(check_record_bytes("").checks) == Names{"complete", "grammar"});
  CHECK(broken(check_record_bytes(std::string(5000, 'x')).checks) == Names{"complete", "grammar"});
  CHECK(broken(check_record("/nonexistent.h5")) == Names{"readable"});
  CHECK(broken(check_record("/tmp")) == Names{"readable"});
}
