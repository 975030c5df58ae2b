// Each rule on and off over the same patterns: largest differences and the factor that it saves. CPU seconds of runs that alternate, so
// that a busy machine slows both alike.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "solver/phasefield/phase_field.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

using Made = std::unique_ptr<GridSimulation>;

struct Rule {
  std::string_view name;
  std::string_view meaning;
  Made (*keep)(const Scene&);  // the full way
  Made (*save)(const Scene&);  // with the rule
};

Made as_it_is(const Scene& scene) { return make_phase_field(scene); }

Made in_float(const Scene& scene) { return std::make_unique<phasefield::PhaseField<float>>(scene, phasefield::chosen_kernels<float>()); }

// psi to a tolerance, in double.
Made settled_to(const Scene& scene, double tolerance) {
  auto made = std::make_unique<phasefield::PhaseField<double>>(scene, phasefield::chosen_kernels<double>());
  made->model().damage_tolerance = tolerance;
  return made;
}
Made settled_fully(const Scene& scene) { return settled_to(scene, 1e-9); }

Made without_plasticity(Scene scene) {
  scene.phase_field.plasticity = PlasticityModel::none;
  return make_phase_field(scene);
}

template <bool Rules::*rule>
Made without_rule(const Scene& scene) {
  Rules rules;
  rules.*rule = false;
  return make_phase_field(scene, rules);
}

constexpr Rule table[]{
    {"linear", "no work on psi until it could rise", without_rule<&Rules::linear_until_damage>, as_it_is},
    {"yield", "the plastic law on those tiles only that yield", without_rule<&Rules::plastic_where_it_yields>, as_it_is},
    {"moves", "after the first sweeps only rows whose psi moved", without_rule<&Rules::sweep_where_it_moves>, as_it_is},
    {"rest", "tiles whose psi hardly moves are left alone in three of four steps, but for their forces",
     without_rule<&Rules::work_where_it_moves>, as_it_is},
    {"float", "numbers of 32 bits against 64", as_it_is, in_float},
    {"settle", "rows are swept until psi is good to the solver's tolerance, against 1e-9", settled_fully, as_it_is},
    {"settle-1e-3", "the same with a tolerance of 1e-3", settled_fully, [](const Scene& scene) { return settled_to(scene, 1e-3); }},
    {"elastic", "no plasticity at all: the most that plasticity only where it matters may save", as_it_is,
     [](const Scene& scene) { return without_plasticity(scene); }},
};

struct Pair {
  Case which;
  std::optional<double> time;  // relative differences
  double peak = 0.0, dice_half = 1.0, dice_open = 1.0;
  bool same_rule = true;
  double full_cpu_s = 0.0, saved_cpu_s = 0.0;
  std::string trouble;
};

Pair compare(const Rule& rule, const Case& which, const Choice& choice) {
  const Scene scene = scene_of(which, choice);
  const Ending a = ending_of(scene, *rule.keep(scene)), b = ending_of(scene, *rule.save(scene));
  Pair pair;
  pair.which = which, pair.trouble = a.trouble + b.trouble;
  pair.time = apart(b.time, a.time);
  pair.peak = apart(b.peak, a.peak).value_or(0.0);
  pair.dice_half = dice(b.psi, a.psi, 0.5), pair.dice_open = dice(b.psi, a.psi, 0.9);
  pair.same_rule = a.rule == b.rule;
  pair.full_cpu_s = a.cpu_s, pair.saved_cpu_s = b.cpu_s;
  return pair;
}

struct Line {
  const Rule* rule;
  std::string material, load;
  Spread time, peak, dice_half, dice_open;
  std::size_t other_rule = 0, troubles = 0, count = 0;
  double factor = 0.0;
};

Line line_of(const Rule& rule, const std::string& material, const std::string& load, const std::vector<Pair>& pairs) {
  Line line{&rule, material, load, {}, {}, {}, {}};
  std::vector<double> time, peak, half, open;
  double full = 0.0, saved = 0.0;
  for (const Pair& p : pairs) {
    if (p.which.material != material || p.which.load != load) continue;
    ++line.count;
    if (!p.trouble.empty()) {
      ++line.troubles;
      continue;
    }
    if (p.time) time.push_back(*p.time);
    peak.push_back(p.peak), half.push_back(p.dice_half), open.push_back(p.dice_open);
    line.other_rule += !p.same_rule;
    full += p.full_cpu_s, saved += p.saved_cpu_s;
  }
  line.time = spread_of(time), line.peak = spread_of(peak), line.dice_half = spread_of(half), line.dice_open = spread_of(open);
  line.factor = saved > 0.0 ? full / saved : 0.0;
  return line;
}

void print_text(const std::vector<Line>& lines) {
  std::vector<std::vector<std::string>> rows{{"rule", "material", "load", "runs", "time mean %", "largest %", "peak largest %",
                                              "Dice 0.5 least", "Dice 0.9 least", "other criterion", "trouble", "faster"}};
  for (const Line& l : lines)
    rows.push_back({std::string(l.rule->name), l.material, l.load, std::to_string(l.count), fmt::format("{:.4f}", 100.0 * l.time.mean),
                    fmt::format("{:.4f}", 100.0 * l.time.most), fmt::format("{:.5f}", 100.0 * l.peak.most),
                    fmt::format("{:.4f}", l.dice_half.least), fmt::format("{:.4f}", l.dice_open.least), std::to_string(l.other_rule),
                    std::to_string(l.troubles), fmt::format("{:.2f}", l.factor)});
  fmt::print("{}\n", table_text(rows));
  for (const Rule& rule : table) fmt::print("{}: {}\n", rule.name, rule.meaning);
}

void print_json(const std::vector<Line>& lines) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const Line& l : lines)
    list.push_back({{"rule", l.rule->name},
                    {"material", l.material},
                    {"load", l.load},
                    {"runs", l.count},
                    {"time_mean", l.time.mean},
                    {"time_largest", l.time.most},
                    {"peak_largest", l.peak.most},
                    {"dice_half_least", l.dice_half.least},
                    {"dice_open_least", l.dice_open.least},
                    {"other_criterion", l.other_rule},
                    {"troubles", l.troubles},
                    {"factor", l.factor}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.rules/1"}, {"rows", list}}.dump(2));
}

}  // namespace

std::vector<std::string> rule_names() {
  std::vector<std::string> names;
  for (const Rule& rule : table) names.emplace_back(rule.name);
  return names;
}

int rules(const RulesQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<Line> lines;
  for (const Rule& rule : table) {
    const auto& wanted = question.rules;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), rule.name) == wanted.end()) continue;
    std::vector<Pair> pairs(cases.size());
    for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { pairs[k] = compare(rule, cases[k], question.choice); });
    for (const std::string& material : question.choice.materials)
      for (const std::string& load : question.choice.loads) lines.push_back(line_of(rule, material, load, pairs));
  }
  question.json ? print_json(lines) : print_text(lines);
  return exit_ok;
}

}  // namespace fracfarm::studies
