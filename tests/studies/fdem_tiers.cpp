// The cheaper tiers of FDEM against the reference tier: fast on the same mesh, screening on its own. Beside them what other things move:
// the fast tier against itself with a millionth more toughness (chaos), and the reference tier with a tenth less penalty, which is as good
// a reference (what no comparison can go below). Last, the fast tier against the reference tier with the softness of its joints made up
// for.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "solver/fdem/materials.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

constexpr double floor_nudge = 1e-6;       // of G: what it moves is no matter of the tier
constexpr double softer_reference = 90.0;  // E/h, in place of 100

struct Compared {
  std::string trouble;
  double peak = 0.0, drop = 0.0, edges = 0.0, length = 0.0;  // relative
  double cpu_s = 0.0, judge_cpu_s = 0.0;
  std::size_t alarms = 0;
  double residual = 0.0;
  bool within = false;
};

struct TierCase {
  Case which;
  double reference_residual = 0.0;
  std::size_t reference_alarms = 0;
  Compared fast, nudged, softer, screening, exact;
};

// Broken edges are counted up to the earlier of both ends.
Compared compare(const FdemRun& run, const FdemRun& judge, const FdemTiersQuestion& question) {
  Compared c;
  c.trouble = run.trouble + judge.trouble;
  if (c.trouble.empty() && (!run.drop10 || !judge.drop10)) c.trouble = "no stress drop";
  if (!c.trouble.empty()) return c;
  c.peak = share_apart(run.peak, judge.peak), c.drop = share_apart(*run.drop10, *judge.drop10);
  const double common = std::min(run.last_time, judge.last_time);
  const Broken ours = broken_by(run, common), theirs = broken_by(judge, common);
  c.edges = share_apart(static_cast<double>(ours.edges), static_cast<double>(theirs.edges));
  c.length = share_apart(ours.length, theirs.length);
  c.cpu_s = run.cpu_s, c.judge_cpu_s = judge.cpu_s;
  c.alarms = run.notes.size(), c.residual = run.residual;
  c.within = c.peak <= question.peak_limit && c.drop <= question.drop_limit && c.edges <= question.edges_limit;
  return c;
}

// The reference tier's penalty and numbers, between triangles that make up for the joints: as stiff as the material.
Scene stiff_reference(Scene scene) {
  const Material& material = scene.layers.front().material;
  scene.fdem.penalty = 100.0 * fdem::young_of(material) / material.elasticity.C11;
  scene.fdem.precision = Precision::double_;
  return scene;
}

TierCase solve_case(const Case& which, const FdemTiersQuestion& question) {
  const auto at = [&](FdemTier tier) { return fdem_scene(which, question.choice.seed, tier); };
  Scene nudged = at(FdemTier::fast);
  for (Layer& layer : nudged.layers) layer.material.cohesion->GI *= 1.0 + floor_nudge, layer.material.cohesion->GII *= 1.0 + floor_nudge;
  Scene softer = at(FdemTier::reference);
  softer.fdem.penalty = softer_reference;
  const FdemRun reference = run_fdem(at(FdemTier::reference)), fast = run_fdem(at(FdemTier::fast));
  return {which,
          reference.residual,
          reference.notes.size(),
          compare(fast, reference, question),
          compare(run_fdem(nudged), fast, question),
          compare(run_fdem(softer), reference, question),
          compare(run_fdem(at(FdemTier::screening)), reference, question),
          compare(fast, run_fdem(stiff_reference(at(FdemTier::fast))), question)};
}

struct Kind {
  std::string_view name;
  Compared TierCase::*compared;
};
constexpr Kind kinds[]{{"fast", &TierCase::fast},
                       {"fast, G + 1e-6", &TierCase::nudged},
                       {"reference, p - 10 %", &TierCase::softer},
                       {"screening", &TierCase::screening},
                       {"fast, stiff reference", &TierCase::exact}};

struct Summary {
  Spread peak, drop, edges, length, cpu, factor, residual, reference_residual;
  std::size_t runs = 0, within = 0, troubles = 0, alarms = 0;
};

Summary summary_of(const std::vector<TierCase>& cases, const std::string& material, Compared TierCase::*compared) {
  Summary s;
  std::vector<double> peak, drop, edges, length, cpu, factor, residual, reference_residual;
  for (const TierCase& one : cases) {
    if (one.which.material != material) continue;
    const Compared& c = one.*compared;
    ++s.runs, s.troubles += !c.trouble.empty(), s.within += c.within, s.alarms += c.alarms;
    if (!c.trouble.empty()) continue;
    peak.push_back(c.peak), drop.push_back(c.drop), edges.push_back(c.edges), length.push_back(c.length);
    cpu.push_back(c.cpu_s), factor.push_back(c.judge_cpu_s / c.cpu_s), residual.push_back(c.residual);
    reference_residual.push_back(one.reference_residual);
  }
  s.peak = spread_of(peak), s.drop = spread_of(drop), s.edges = spread_of(edges), s.length = spread_of(length), s.cpu = spread_of(cpu);
  s.factor = spread_of(factor), s.residual = spread_of(residual), s.reference_residual = spread_of(reference_residual);
  return s;
}

void print_text(const std::vector<TierCase>& cases, const FdemTiersQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"material", "tier", "within", "peak %", "drop10 %", "broken edges %", "broken length %",
                                              "CPU s", "faster", "energy %", "alarms", "trouble"}};
  std::vector<std::vector<std::string>> missing{{"past a limit", "peak %", "drop10 %", "broken edges %", "why"}};
  for (const std::string& material : question.choice.materials)
    for (const Kind& kind : kinds) {
      const Summary s = summary_of(cases, material, kind.compared);
      rows.push_back({material, std::string(kind.name), fmt::format("{} of {}", s.within, s.runs), mean_most(s.peak), mean_most(s.drop),
                      mean_most(s.edges, 1), mean_most(s.length, 1), fmt::format("{:.2f}", s.cpu.mean),
                      fmt::format("{:.1f}", s.factor.mean), mean_most(s.residual, 3), std::to_string(s.alarms),
                      std::to_string(s.troubles)});
    }
  for (const TierCase& one : cases)
    if (const Compared& c = one.fast; !c.within)
      missing.push_back({fmt::format("{} {}", one.which.material, one.which.pattern), fmt::format("{:.2f}", 100.0 * c.peak),
                         fmt::format("{:.2f}", 100.0 * c.drop), fmt::format("{:.1f}", 100.0 * c.edges), c.trouble});
  fmt::print("against the reference tier; mean / largest; energy: residual over work\n{}\n", table_text(rows));
  if (missing.size() > 1) fmt::print("{}\n", table_text(missing));
}

nlohmann::ordered_json json_of(const Compared& c) {
  return {{"peak", c.peak},          {"drop10", c.drop},
          {"broken_edges", c.edges}, {"broken_length", c.length},
          {"cpu_s", c.cpu_s},        {"judge_cpu_s", c.judge_cpu_s},
          {"residual", c.residual},  {"alarms", c.alarms},
          {"within", c.within},      {"trouble", c.trouble}};
}

void print_json(const std::vector<TierCase>& cases, const FdemTiersQuestion& question) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const TierCase& one : cases)
    list.push_back({{"material", one.which.material},
                    {"pattern", one.which.pattern},
                    {"reference_residual", one.reference_residual},
                    {"reference_alarms", one.reference_alarms},
                    {"fast", json_of(one.fast)},
                    {"nudged", json_of(one.nudged)},
                    {"softer", json_of(one.softer)},
                    {"screening", json_of(one.screening)},
                    {"stiff_reference", json_of(one.exact)}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_tiers/1"},
                          {"peak_limit", question.peak_limit},
                          {"drop_limit", question.drop_limit},
                          {"edges_limit", question.edges_limit},
                          {"cases", list}}
                         .dump(2));
}

}  // namespace

int fdem_tiers(const FdemTiersQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<TierCase> solved(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solved[k] = solve_case(cases[k], question); });
  question.json ? print_json(solved, question) : print_text(solved, question);
  const bool all_within = std::all_of(solved.begin(), solved.end(), [](const TierCase& one) { return one.fast.within; });
  return all_within ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
