// Each of FDEM's rules on and off over the same patterns, run to 1.8 times the stress drop: is a run with the rule the run without it, and
// how much faster. CPU seconds of runs that follow each other, so that a busy machine slows both alike.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

struct FdemRule {
  std::string_view name, meaning;
  void (*leave_out)(Scene&, RunControl&);
};

constexpr FdemRule table[]{
    {"contact", "no contact before the first broken edge, and around broken edges only",
     [](Scene&, RunControl& control) { control.rules.contact_after_break = false; }},
    {"softening", "damage arithmetic only where lambda > 1 or D > 0",
     [](Scene&, RunControl& control) { control.rules.damage_where_stretched = false; }},
    {"flow", "the radial return only where f > 0", [](Scene&, RunControl& control) { control.rules.flow_where_it_yields = false; }},
    {"float", "numbers of 32 bits against 64", [](Scene& scene, RunControl&) { scene.fdem.precision = Precision::double_; }},
};

constexpr double near = 0.001;  // of drop10: what counts as the same instant

struct Pair {
  Case which;
  RunDifference off;
  bool same_bits = false;
  double with_cpu_s = 0.0, without_cpu_s = 0.0;
};

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool same_run(const FdemRun& a, const FdemRun& b) {
  bool same = same_numbers(a.layout.break_time, b.layout.break_time) && a.layout.break_mode == b.layout.break_mode;
  for (std::size_t k = 0; k < a.series.columns.size() && same; ++k)
    same = same_numbers(a.series.columns[k].values, b.series.columns[k].values);
  return same;
}

Pair compare(const FdemRule& rule, const Case& which, std::uint64_t seed) {
  Scene scene = fdem_scene(which, seed);
  const FdemRun with = run_fdem(scene);
  RunControl control;
  rule.leave_out(scene, control);
  const FdemRun without = run_fdem(scene, control);
  Pair pair{which, difference(with, without, near), false, with.cpu_s, without.cpu_s};
  if (pair.off.trouble.empty()) pair.same_bits = same_run(with, without);
  return pair;
}

struct Line {
  const FdemRule* rule;
  std::string material;
  std::size_t runs = 0, same_bits = 0, troubles = 0;
  Spread peak, drop, threshold, edges;
  double factor = 0.0;
};

Line line_of(const FdemRule& rule, const std::string& material, const std::vector<Pair>& pairs) {
  Line line{&rule, material, 0, 0, 0, {}, {}, {}, {}};
  std::vector<double> peak, drop, threshold, edges;
  double with = 0.0, without = 0.0;
  for (const Pair& p : pairs) {
    if (p.which.material != material) continue;
    ++line.runs, line.troubles += !p.off.trouble.empty(), line.same_bits += p.same_bits;
    if (!p.off.trouble.empty()) continue;
    peak.push_back(p.off.peak), drop.push_back(p.off.drop10), threshold.push_back(p.off.threshold), edges.push_back(p.off.edges);
    with += p.with_cpu_s, without += p.without_cpu_s;
  }
  line.peak = spread_of(peak), line.drop = spread_of(drop), line.edges = spread_of(edges);
  line.threshold = spread_of(threshold);
  line.factor = with > 0.0 ? without / with : 0.0;
  return line;
}

void print_text(const std::vector<Line>& lines) {
  std::vector<std::vector<std::string>> rows{
      {"rule", "material", "same bits", "peak %", "drop10 %", "threshold", "broken edges %", "trouble", "faster"}};
  for (const Line& l : lines)
    rows.push_back({std::string(l.rule->name), l.material, fmt::format("{} of {}", l.same_bits, l.runs), mean_most(l.peak, 4),
                    mean_most(l.drop, 3), mean_most(l.threshold, 3), mean_most(l.edges), std::to_string(l.troubles),
                    fmt::format("{:.2f}", l.factor)});
  fmt::print("with each rule against without it; mean / largest; threshold: how far from 10 % of the peak both drops are within {} %\n{}\n",
             100.0 * near, table_text(rows));
  for (const FdemRule& rule : table) fmt::print("{}: {}\n", rule.name, rule.meaning);
}

void print_json(const std::vector<Line>& lines) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const Line& l : lines)
    list.push_back({{"rule", l.rule->name},
                    {"material", l.material},
                    {"runs", l.runs},
                    {"same_bits", l.same_bits},
                    {"peak_mean", l.peak.mean},
                    {"peak_largest", l.peak.most},
                    {"drop10_mean", l.drop.mean},
                    {"drop10_largest", l.drop.most},
                    {"threshold_largest", l.threshold.most},
                    {"broken_edges_mean", l.edges.mean},
                    {"broken_edges_largest", l.edges.most},
                    {"troubles", l.troubles},
                    {"factor", l.factor}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_rules/1"}, {"rows", list}}.dump(2));
}

}  // namespace

int fdem_rules(const FdemRulesQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<Line> lines;
  for (const FdemRule& rule : table) {
    std::vector<Pair> pairs(cases.size());
    for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { pairs[k] = compare(rule, cases[k], question.choice.seed); });
    for (const std::string& material : question.choice.materials) lines.push_back(line_of(rule, material, pairs));
  }
  question.json ? print_json(lines) : print_text(lines);
  return exit_ok;
}

}  // namespace fracfarm::studies
