// The cheaper tiers of FDEM against the reference tier: fast on the same mesh, screening on its own. What the reference tier is from itself
// is another study, fdem_floor.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

struct Compared {
  RunDifference off;
  double cpu_s = 0.0, judge_cpu_s = 0.0;
  std::size_t alarms = 0;
  double residual = 0.0;
  bool peak = false, drop = false, edges = false;  // within the limit
  bool within() const { return peak && drop && edges; }
};

struct TierCase {
  Case which;
  double reference_residual = 0.0;
  std::size_t reference_alarms = 0;
  Compared fast, screening;
};

Compared compare(const FdemRun& run, const FdemRun& judge, const FdemTiersQuestion& question) {
  Compared c;
  c.off = difference(run, judge, question.drop_limit);
  if (!c.off.trouble.empty()) return c;
  c.cpu_s = run.cpu_s, c.judge_cpu_s = judge.cpu_s;
  c.alarms = run.notes.size(), c.residual = run.residual;
  c.peak = c.off.peak <= question.peak_limit, c.drop = c.off.drop10 <= question.drop_limit;
  c.edges = c.off.edges <= question.edges_limit;
  return c;
}

TierCase solve_case(const Case& which, const FdemTiersQuestion& question) {
  const auto at = [&](FdemTier tier) { return fdem_scene(which, question.choice.seed, tier); };
  const FdemRun reference = run_fdem(at(FdemTier::reference)), fast = run_fdem(at(FdemTier::fast));
  return {which, reference.residual, reference.notes.size(), compare(fast, reference, question),
          compare(run_fdem(at(FdemTier::screening)), reference, question)};
}

struct Kind {
  std::string_view name;
  Compared TierCase::*compared;
};
constexpr Kind kinds[]{{"fast", &TierCase::fast}, {"screening", &TierCase::screening}};

struct Summary {
  Spread peak, drop10, drop11, drop9, threshold, edges, length, cpu, factor, residual;
  std::size_t runs = 0, within = 0, peaks = 0, drops = 0, edge_counts = 0, troubles = 0, alarms = 0;
};

Summary summary_of(const std::vector<TierCase>& cases, const std::string& material, Compared TierCase::*compared) {
  Summary s;
  std::vector<const TierCase*> good;
  for (const TierCase& one : cases) {
    if (one.which.material != material) continue;
    const Compared& c = one.*compared;
    ++s.runs, s.troubles += !c.off.trouble.empty(), s.alarms += c.alarms;
    s.within += c.within(), s.peaks += c.peak, s.drops += c.drop, s.edge_counts += c.edges;
    if (c.off.trouble.empty()) good.push_back(&one);
  }
  const auto spread = [&](auto value) {
    std::vector<double> values;
    for (const TierCase* one : good) values.push_back(value(one->*compared));
    return spread_of(values);
  };
  const auto part = [&](double RunDifference::*figure) { return spread([figure](const Compared& c) { return c.off.*figure; }); };
  s.peak = part(&RunDifference::peak), s.edges = part(&RunDifference::edges), s.length = part(&RunDifference::length);
  s.drop10 = part(&RunDifference::drop10), s.drop11 = part(&RunDifference::drop11), s.drop9 = part(&RunDifference::drop9),
  s.threshold = part(&RunDifference::threshold);
  s.cpu = spread([](const Compared& c) { return c.cpu_s; }), s.residual = spread([](const Compared& c) { return c.residual; });
  s.factor = spread([](const Compared& c) { return c.judge_cpu_s / c.cpu_s; });
  return s;
}

void print_text(const std::vector<TierCase>& cases, const FdemTiersQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"material", "tier", "within (peak, drop10, edges)", "peak %", "drop10 %", "at 11 %", "at 9 %",
                                              "threshold", "broken edges %", "broken length %", "CPU s", "faster", "energy %", "alarms",
                                              "trouble"}};
  std::vector<std::vector<std::string>> missing{
      {"past a limit", "peak %", "drop10 %", "at 11 %", "at 9 %", "threshold", "broken edges %", "why"}};
  for (const std::string& material : question.choice.materials)
    for (const Kind& kind : kinds) {
      const Summary s = summary_of(cases, material, kind.compared);
      rows.push_back({material, std::string(kind.name),
                      fmt::format("{} of {} ({}, {}, {})", s.within, s.runs, s.peaks, s.drops, s.edge_counts), mean_most(s.peak),
                      mean_most(s.drop10), mean_most(s.drop11), mean_most(s.drop9), mean_most(s.threshold), mean_most(s.edges, 1),
                      mean_most(s.length, 1), fmt::format("{:.2f}", s.cpu.mean), fmt::format("{:.1f}", s.factor.mean),
                      mean_most(s.residual, 3), std::to_string(s.alarms), std::to_string(s.troubles)});
    }
  const auto percent = [](double value, int digits) { return fmt::format("{:.{}f}", 100.0 * value, digits); };
  for (const TierCase& one : cases)
    if (const RunDifference& a = one.fast.off; !one.fast.within())
      missing.push_back({fmt::format("{} {}", one.which.material, one.which.pattern), percent(a.peak, 2), percent(a.drop10, 2),
                         percent(a.drop11, 2), percent(a.drop9, 2), percent(a.threshold, 2), percent(a.edges, 1), a.trouble});
  fmt::print(
      "against the reference tier; mean / largest; energy: residual over work; threshold: how far from 10 % of the peak the "
      "reference tier's drop comes within {} % of the tier's drop10\n{}\n",
      100.0 * question.drop_limit, table_text(rows));
  if (missing.size() > 1) fmt::print("{}\n", table_text(missing));
}

nlohmann::ordered_json json_of(const Compared& c) {
  return {{"peak", c.off.peak},
          {"drop10", c.off.drop10},
          {"drop11", c.off.drop11},
          {"drop9", c.off.drop9},
          {"threshold", c.off.threshold},
          {"broken_edges", c.off.edges},
          {"broken_length", c.off.length},
          {"cpu_s", c.cpu_s},
          {"judge_cpu_s", c.judge_cpu_s},
          {"residual", c.residual},
          {"alarms", c.alarms},
          {"within", c.within()},
          {"trouble", c.off.trouble}};
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
                    {"screening", json_of(one.screening)}});
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
  const bool all_within = std::all_of(solved.begin(), solved.end(), [](const TierCase& one) { return one.fast.within(); });
  return all_within ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
