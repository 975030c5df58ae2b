// FDEM and the phase field on the same patterns: times, strength, and how far apart their cracks are. The phase field runs twice: with the
// loads of its own dataset (a velocity step, free along the side) and with FDEM's (ramped, held by plates).
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/picture/mesh_picture.hpp"
#include "common/picture/plot.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

constexpr double reach = 0.006;  // m, two elements of the mesh and three cells of the grid: cracks closer than this are at the same place
constexpr double open = 0.9;     // psi above it is crack

using Points = std::vector<std::array<double, 2>>;  // m

// How far two sets of cracks are apart.
struct Overlap {
  double of_fdem = 0.0, of_field = 0.0;  // shares of each that lie within reach of the other
  double hausdorff = 0.0;                // m, the larger of both 95 % distances
};

// New cracks only: what was open from the start is the same in both.
Points cracks_of(const FdemRun& run) {
  Points points;
  const TriangleMesh& mesh = run.layout.mesh;
  for (std::size_t edge = 0; edge < mesh.edge_nodes.size(); ++edge) {
    if (std::isnan(run.layout.break_time[edge])) continue;
    const auto &a = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][0])],
               &b = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][1])];
    for (const double s : {0.25, 0.75}) points.push_back({a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])});
  }
  return points;
}

struct FieldRun {
  Scene scene;
  Ending ending;
  std::vector<float> psi_initial;
};

Points cracks_of(const FieldRun& run) {
  Points points;
  const int columns = run.scene.phase_field.cells_x + 1;
  for (std::size_t n = 0; n < run.ending.psi.size(); ++n) {
    if (!(static_cast<double>(run.ending.psi[n]) > open) || static_cast<double>(run.psi_initial[n]) > open) continue;
    const int i = static_cast<int>(n) % columns, j = static_cast<int>(n) / columns;
    points.push_back({run.scene.width * i / run.scene.phase_field.cells_x, run.scene.height * j / run.scene.phase_field.cells_z});
  }
  return points;
}

std::vector<double> distances(const Points& from, const Points& to) {
  std::vector<double> all;
  for (const auto& p : from) {
    double least = INFINITY;
    for (const auto& q : to) least = std::min(least, (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]));
    all.push_back(std::sqrt(least));
  }
  std::sort(all.begin(), all.end());
  return all;
}

Overlap overlap_of(const Points& fdem, const Points& field) {
  if (fdem.empty() || field.empty()) return {0.0, 0.0, INFINITY};
  const std::vector<double> a = distances(fdem, field), b = distances(field, fdem);
  const auto near = [](const std::vector<double>& d) {
    return static_cast<double>(std::upper_bound(d.begin(), d.end(), reach) - d.begin()) / static_cast<double>(d.size());
  };
  return {near(a), near(b), std::max(a[a.size() * 95 / 100], b[b.size() * 95 / 100])};
}

FieldRun run_field(const Case& which, std::uint64_t seed, const Scene* loads) {
  Choice choice;
  choice.seed = seed;
  FieldRun run{scene_of(which, choice), {}, {}};
  if (loads) run.scene.loads = loads->loads, run.scene.horizon *= 2.0, run.scene.frame_interval = run.scene.horizon;
  run.scene.phase_field.precision = Precision::float_;
  if (Result<RunResult> result = solve(run.scene, {})) {
    run.ending.rule = result->judgement.rule, run.ending.time = result->judgement.time_to_failure, run.ending.peak = result->peak_stress;
    for (const FailureTime& time : result->times)
      if (time.rule == "stress_drop") run.ending.stress_drop = time.time;
    run.ending.psi = std::move(result->damage_failure), run.psi_initial = std::move(result->damage_initial);
  } else {
    run.ending.trouble = result.error().message;
  }
  return run;
}

struct MethodCase {
  Case which;
  FdemRun fdem;
  FieldRun own, same;  // phase field with its own loads, and with FDEM's
  Overlap with_own, with_same, by_chance;
};

MethodCase solve_case(const Case& which, std::uint64_t seed) {
  const Scene scene = fdem_scene(which, seed);
  MethodCase one{which, run_fdem(scene), run_field(which, seed, nullptr), run_field(which, seed, &scene), {}, {}, {}};
  one.with_own = overlap_of(cracks_of(one.fdem), cracks_of(one.own));
  one.with_same = overlap_of(cracks_of(one.fdem), cracks_of(one.same));
  return one;
}

// What two sets of cracks have in common that have nothing in common: FDEM's against the phase field's of the next pattern.
void add_chance(std::vector<MethodCase>& cases) {
  for (std::size_t k = 0; k < cases.size(); ++k)
    for (std::size_t step = 1; step < cases.size(); ++step) {
      const MethodCase& other = cases[(k + step) % cases.size()];
      if (other.which.material != cases[k].which.material) continue;
      cases[k].by_chance = overlap_of(cracks_of(cases[k].fdem), cracks_of(other.same));
      break;
    }
}

using Value = std::optional<double> (*)(const MethodCase&);

std::string of(const std::vector<MethodCase>& cases, const std::string& material, double scale, int digits, Value value) {
  std::vector<double> values;
  for (const MethodCase& one : cases)
    if (one.which.material == material)
      if (const auto v = value(one); v && std::isfinite(*v)) values.push_back(scale * *v);
  const Spread s = spread_of(values);
  return s.count ? fmt::format("{:.{}f} ({:.{}f} - {:.{}f})", s.mean, digits, s.least, digits, s.most, digits) : "-";
}

struct Figure {
  const char* name;
  double scale;
  int digits;
  Value value;
};
constexpr Figure figures[]{
    {"FDEM: peak MPa", 1e-6, 2, [](const MethodCase& c) { return std::optional(c.fdem.peak); }},
    {"phase field, same loads: peak MPa", 1e-6, 2, [](const MethodCase& c) { return std::optional(c.same.ending.peak); }},
    {"phase field, its own loads: peak MPa", 1e-6, 2, [](const MethodCase& c) { return std::optional(c.own.ending.peak); }},
    {"FDEM: drop10 us", 1e6, 0, [](const MethodCase& c) { return c.fdem.drop10; }},
    {"phase field, same loads: stress drop us", 1e6, 0, [](const MethodCase& c) { return c.same.ending.stress_drop; }},
    {"phase field, same loads: through crack us", 1e6, 0,
     [](const MethodCase& c) { return c.same.ending.rule == "through_crack" ? c.same.ending.time : std::nullopt; }},
    {"phase field, its own loads: stress drop us", 1e6, 0, [](const MethodCase& c) { return c.own.ending.stress_drop; }},
    {"same loads: share of FDEM's cracks near %", 100, 0, [](const MethodCase& c) { return std::optional(c.with_same.of_fdem); }},
    {"same loads: share of the phase field's near %", 100, 0, [](const MethodCase& c) { return std::optional(c.with_same.of_field); }},
    {"same loads: 95 % Hausdorff mm", 1e3, 0, [](const MethodCase& c) { return std::optional(c.with_same.hausdorff); }},
    {"own loads: share of FDEM's cracks near %", 100, 0, [](const MethodCase& c) { return std::optional(c.with_own.of_fdem); }},
    {"own loads: share of the phase field's near %", 100, 0, [](const MethodCase& c) { return std::optional(c.with_own.of_field); }},
    {"own loads: 95 % Hausdorff mm", 1e3, 0, [](const MethodCase& c) { return std::optional(c.with_own.hausdorff); }},
    {"another pattern: share of FDEM's cracks near %", 100, 0, [](const MethodCase& c) { return std::optional(c.by_chance.of_fdem); }},
    {"another pattern: share of the phase field's near %", 100, 0, [](const MethodCase& c) { return std::optional(c.by_chance.of_field); }},
    {"another pattern: 95 % Hausdorff mm", 1e3, 0, [](const MethodCase& c) { return std::optional(c.by_chance.hausdorff); }},
};

void print_text(const std::vector<MethodCase>& cases, const FdemMethodsQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"mean (least - most) of the patterns"}};
  for (const std::string& material : question.choice.materials) rows[0].push_back(material);
  for (const Figure& figure : figures) {
    rows.push_back({figure.name});
    for (const std::string& material : question.choice.materials)
      rows.back().push_back(of(cases, material, figure.scale, figure.digits, figure.value));
  }
  fmt::print("near: within {} mm; new cracks only\n{}\n", 1e3 * reach, table_text(rows));
  for (const MethodCase& one : cases)
    if (const std::string trouble = one.fdem.trouble + one.own.ending.trouble + one.same.ending.trouble; !trouble.empty())
      fmt::print("{} {}: {}\n", one.which.material, one.which.pattern, trouble);
}

void print_json(const std::vector<MethodCase>& cases) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const MethodCase& one : cases) {
    list.push_back({{"material", one.which.material}, {"pattern", one.which.pattern}});
    for (const Figure& figure : figures) {
      const auto v = figure.value(one);
      list.back()[figure.name] = v && std::isfinite(*v) ? Json(figure.scale * *v) : Json(nullptr);
    }
  }
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_methods/1"}, {"reach", reach}, {"cases", list}}.dump(2));
}

constexpr int side = 324, gap = 24, head = 64, caption = 26;

void draw_case(picture::Canvas& canvas, int y, const MethodCase& one) {
  const auto words = [&](int column, const std::string& text) { canvas.text(gap + column * (side + gap), y + 18, text); };
  const auto place = [&](int column, const picture::Canvas& drawn) { canvas.place(drawn, gap + column * (side + gap), y + caption); };
  const auto field = [&](const FieldRun& run) {
    const int columns = run.scene.phase_field.cells_x + 1, rows = run.scene.phase_field.cells_z + 1;
    return picture::draw_field({run.ending.psi, columns, rows}, side, side);
  };
  const auto told = [](const FieldRun& run, const char* loads) {
    return fmt::format("{}: {:.1f} MPa, {} {:.0f} us", loads, 1e-6 * run.ending.peak,
                       run.ending.rule == "through_crack" ? "through crack" : run.ending.rule, 1e6 * run.ending.time.value_or(NAN));
  };
  words(0, fmt::format("{} {}, FDEM: {:.1f} MPa, drop10 {:.0f} us", one.which.material, one.which.pattern, 1e-6 * one.fdem.peak,
                       1e6 * one.fdem.drop10.value_or(NAN)));
  place(0, picture::draw_mesh(one.fdem.layout.mesh, broken_field(one.fdem, one.fdem.last_time), side));
  words(1, told(one.same, "same loads")), place(1, field(one.same));
  words(2, told(one.own, "velocity step")), place(2, field(one.own));
}

picture::Canvas draw(const std::vector<MethodCase>& cases, int pattern) {
  std::vector<const MethodCase*> shown;
  for (const MethodCase& one : cases)
    if (one.which.pattern == pattern) shown.push_back(&one);
  picture::Canvas canvas(3 * side + 4 * gap, head + static_cast<int>(shown.size()) * (side + caption + gap));
  canvas.text(gap, 30, "The same initial cracks, two methods", picture::black, picture::Align::left, picture::Font::bold);
  canvas.text(gap, 52,
              "left: triangles and joints, initial cracks blue, broken edges red at 1.8 drop10; middle and right: psi of the phase field "
              "at failure");
  for (std::size_t k = 0; k < shown.size(); ++k)
    if (shown[k]->fdem.trouble.empty()) draw_case(canvas, head + static_cast<int>(k) * (side + caption + gap), *shown[k]);
  return canvas;
}

}  // namespace

int fdem_methods(const FdemMethodsQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<MethodCase> solved(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solved[k] = solve_case(cases[k], question.choice.seed); });
  add_chance(solved);
  question.json ? print_json(solved) : print_text(solved, question);
  if (question.picture.empty()) return exit_ok;
  const auto kept = write_atomically(question.picture, picture::png_bytes(draw(solved, question.picture_pattern)));
  if (!kept) fmt::print(stderr, "{}\n", kept.error().message);
  return kept ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
