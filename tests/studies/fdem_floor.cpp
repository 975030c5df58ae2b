// How far FDEM's reference tier is from itself, pattern by pattern: what no comparison with it can go below. With half the step and a
// billionth more toughness (numerics), with a tenth less penalty (as good a reference), on another mesh of the same size (as good a body).
// Beside them the fast tier.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

void leave(Scene&) {}

void half_the_step(Scene& scene) { scene.fdem.dt_fraction *= 0.5; }

void tougher(Scene& scene) {
  for (Layer& layer : scene.layers) layer.material.cohesion->GI *= 1.0 + 1e-9, layer.material.cohesion->GII *= 1.0 + 1e-9;
}

void softer(Scene& scene) { scene.fdem.penalty = 90.0; }  // E/h, in place of 100

void another_mesh(Scene& scene) { ++scene.fdem.mesh_seed; }

void fast(Scene& scene) { scene.fdem = defaults_of(FdemTier::fast); }

// Of a scene of the reference tier; the first is the reference.
constexpr std::array<void (*)(Scene&), 6> changes{leave, half_the_step, tougher, softer, another_mesh, fast};

struct Kind {
  std::string_view name;
  std::size_t run, judge;  // of the changes
};

constexpr std::array<Kind, 5> kinds{
    {{"half the step", 1, 0}, {"G + 1e-9", 2, 0}, {"penalty - 10 %", 3, 0}, {"another mesh", 4, 0}, {"fast tier", 5, 0}}};

struct FloorCase {
  Case which;
  std::array<RunDifference, kinds.size()> off;
};

FloorCase solve_case(const Case& which, const FdemFloorQuestion& question) {
  std::array<FdemRun, changes.size()> runs;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    Scene scene = fdem_scene(which, question.choice.seed, FdemTier::reference);
    changes[k](scene);
    runs[k] = run_fdem(scene);
  }
  FloorCase one{which, {}};
  for (std::size_t k = 0; k < kinds.size(); ++k) one.off[k] = difference(runs[kinds[k].run], runs[kinds[k].judge], question.near);
  return one;
}

std::vector<Case> chosen(const FdemFloorQuestion& question) {
  if (question.only.empty()) return cases_of(question.choice);
  std::vector<Case> cases;
  for (const std::string& material : question.choice.materials)
    for (int pattern : question.only) cases.push_back({material, "uniaxial", pattern});
  return cases;
}

void print_text(const std::vector<FloorCase>& cases, const FdemFloorQuestion& question) {
  std::vector<std::vector<std::string>> rows{
      {"pattern", "reference tier with", "peak %", "drop10 %", "at 11 %", "at 9 %", "threshold", "broken edges %", "trouble"}};
  const auto percent = [](double value, int digits) { return fmt::format("{:.{}f}", 100.0 * value, digits); };
  for (const FloorCase& one : cases)
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const RunDifference& a = one.off[k];
      rows.push_back({fmt::format("{} {}", one.which.material, one.which.pattern), std::string(kinds[k].name), percent(a.peak, 3),
                      percent(a.drop10, 2), percent(a.drop11, 2), percent(a.drop9, 2), percent(a.threshold, 2), percent(a.edges, 1),
                      a.trouble});
    }
  fmt::print("threshold: how far from 10 % of the peak the reference tier's drop comes within {} % of the run's drop10\n{}\n",
             100.0 * question.near, table_text(rows));
}

void print_json(const std::vector<FloorCase>& cases) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const FloorCase& one : cases)
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const RunDifference& a = one.off[k];
      list.push_back({{"material", one.which.material},
                      {"pattern", one.which.pattern},
                      {"changed", kinds[k].name},
                      {"trouble", a.trouble},
                      {"peak", a.peak},
                      {"drop10", a.drop10},
                      {"drop11", a.drop11},
                      {"drop9", a.drop9},
                      {"threshold", a.threshold},
                      {"broken_edges", a.edges},
                      {"broken_length", a.length}});
    }
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_floor/1"}, {"rows", list}}.dump(2));
}

}  // namespace

int fdem_floor(const FdemFloorQuestion& question) {
  const std::vector<Case> cases = chosen(question);
  std::vector<FloorCase> solved(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solved[k] = solve_case(cases[k], question); });
  question.json ? print_json(solved) : print_text(solved, question);
  return exit_ok;
}

}  // namespace fracfarm::studies
