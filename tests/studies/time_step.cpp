// Time to failure, stress drop, peak and cracks against the step. Where a pattern misses it is looked at again: the same time, a nudged
// toughness, a gentler impact, so that the table says what a miss is made of.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

constexpr double floor_nudge = 1e-6;  // of G_c: what it moves is no matter of the step
constexpr double nudge = 1e-3;        // of G_c: what no material is known to
constexpr double gentle_ramp = 1e-5;  // s
constexpr double missing = -1.0;

// A coarser run against the reference run of one case.
struct Difference {
  double cfl = 0.0;
  std::string rule, reference_rule;
  double time = missing, drop = missing, peak = missing;  // relative
  double dice_half = 0.0, dice_open = 0.0;                // psi > 0.5, psi > 0.9 at failure
  double step_share = 0.0;                                // a step of this run over the time to failure
  bool missed = false;
  // Of the ones that miss only.
  double dice_same_time = missing;                      // psi > 0.5 at the earlier of the two times
  double floor_time = missing, nudged_time = missing;   // reference against itself with G_c (1 + floor_nudge), (1 + nudge)
  double gentle_time = missing, gentle_dice = missing;  // both again with a ramp of gentle_ramp
};

struct CaseResult {
  Case which;
  Ending reference;
  std::vector<Difference> differences;
};

Scene at_cfl(Scene scene, double cfl) {
  scene.phase_field.cfl = cfl;
  return scene;
}

void with_ramp(Scene& scene, double ramp) {
  for (auto& side : scene.loads)
    for (SideLoad& part : side) part.ramp = ramp;
}

Difference compare(const Ending& run, const Ending& reference, double cfl, const TimeStepQuestion& question) {
  Difference d;
  d.cfl = cfl, d.rule = run.rule, d.reference_rule = reference.rule;
  d.time = apart(run.time, reference.time).value_or(missing);
  d.drop = apart(run.stress_drop, reference.stress_drop).value_or(missing);
  d.peak = apart(run.peak, reference.peak).value_or(missing);
  d.dice_half = dice(run.psi, reference.psi, 0.5), d.dice_open = dice(run.psi, reference.psi, 0.9);
  d.step_share = reference.time ? run.dt / *reference.time : 0.0;
  d.missed = d.rule != d.reference_rule || d.time > question.time_limit || d.dice_half < question.dice_limit;
  return d;
}

void look_again(Difference& d, const Scene& scene, const Ending& run, const Ending& reference, const TimeStepQuestion& question) {
  if (run.time && reference.time) {
    const double common = std::min(*run.time, *reference.time);
    d.dice_same_time = dice(damage_at(at_cfl(scene, d.cfl), common), damage_at(at_cfl(scene, question.reference), common), 0.5);
  }
  const auto moved_by = [&](double share) {
    Scene nudged = at_cfl(scene, question.reference);
    for (Layer& layer : nudged.layers) layer.material.Gc *= 1.0 + share;
    return apart(ending_of(nudged).time, reference.time).value_or(missing);
  };
  d.floor_time = moved_by(floor_nudge), d.nudged_time = moved_by(nudge);
  Scene gentle = scene;
  with_ramp(gentle, gentle_ramp);
  const Ending coarse = ending_of(at_cfl(gentle, d.cfl)), fine = ending_of(at_cfl(gentle, question.reference));
  d.gentle_time = apart(coarse.time, fine.time).value_or(missing);
  d.gentle_dice = dice(coarse.psi, fine.psi, 0.5);
}

CaseResult solve_case(const Case& which, const TimeStepQuestion& question) {
  const Scene scene = scene_of(which, question.choice);
  CaseResult result{which, ending_of(at_cfl(scene, question.reference)), {}};
  for (const double cfl : question.cfl) {
    const Ending run = ending_of(at_cfl(scene, cfl));
    Difference d = compare(run, result.reference, cfl, question);
    if (d.missed) look_again(d, scene, run, result.reference, question);
    result.differences.push_back(d);
  }
  return result;
}

// The first thing that explains a miss, from the nearest to the farthest.
std::string explained(const Difference& d, const TimeStepQuestion& question) {
  if (d.rule != d.reference_rule) return "another criterion decides";
  if (d.floor_time > question.time_limit)
    return fmt::format("chaotic: {:.0e} of G_c moves the reference by {:.2f} %", floor_nudge, 100.0 * d.floor_time);
  if (d.dice_same_time >= question.dice_limit && d.drop >= 0.0 && d.drop <= question.time_limit)
    return "same cracks at the same time, same stress drop: a last ligament joins at another time";
  if (d.nudged_time > question.time_limit)
    return fmt::format("{:.0e} of G_c moves the reference by {:.2f} %", nudge, 100.0 * d.nudged_time);
  if (d.gentle_time >= 0.0 && d.gentle_time <= question.time_limit && d.gentle_dice >= question.dice_limit)
    return "met behind a ramp: the impact's wave front";
  return "another crack is taken";
}

using Rows = std::vector<std::vector<std::string>>;

template <class Value>
Spread over(const std::vector<CaseResult>& results, const std::string& material, const std::string& load, std::size_t k, Value value) {
  std::vector<double> values;
  for (const CaseResult& r : results)
    if (r.which.material == material && r.which.load == load)
      if (const double v = value(r.differences[k]); v != missing) values.push_back(v);
  return spread_of(std::move(values));
}

std::string percent(double share) { return share == missing ? "-" : fmt::format("{:.3f}", 100.0 * share); }
std::string three(const Spread& s) {
  return s.count ? fmt::format("{} / {} / {}", percent(s.mean), percent(s.median), percent(s.most)) : "-";
}
std::string two(const Spread& s) { return fmt::format("{:.4f} / {:.4f}", s.mean, s.least); }

Rows summary(const std::vector<CaseResult>& results, const TimeStepQuestion& question) {
  Rows rows{{"material", "load", "CFL", "within", "time to failure %", "stress drop %", "peak %", "Dice 0.5", "Dice 0.9", "a step %"}};
  for (const std::string& material : question.choice.materials)
    for (const std::string& load : question.choice.loads)
      for (std::size_t k = 0; k < question.cfl.size(); ++k) {
        const auto of = [&](auto value) { return over(results, material, load, k, value); };
        const Spread missed = of([](const Difference& d) { return d.missed ? 1.0 : 0.0; });
        rows.push_back({material, load, fmt::format("{}", question.cfl[k]),
                        fmt::format("{:.0f} of {}", static_cast<double>(missed.count) * (1.0 - missed.mean), missed.count),
                        three(of([](const Difference& d) { return d.time; })), three(of([](const Difference& d) { return d.drop; })),
                        three(of([](const Difference& d) { return d.peak; })), two(of([](const Difference& d) { return d.dice_half; })),
                        two(of([](const Difference& d) { return d.dice_open; })),
                        percent(of([](const Difference& d) { return d.step_share; }).mean)});
      }
  return rows;
}

Rows misses(const std::vector<CaseResult>& results, const TimeStepQuestion& question) {
  Rows rows{
      {"missing", "CFL", "time %", "drop %", "Dice 0.5", "same time", "1e-6 G_c %", "1e-3 G_c %", "ramped %", "ramped Dice", "what it is"}};
  for (const CaseResult& r : results)
    for (const Difference& d : r.differences)
      if (d.missed)
        rows.push_back({fmt::format("{} {} {}", r.which.material, r.which.load, r.which.pattern), fmt::format("{}", d.cfl), percent(d.time),
                        percent(d.drop), fmt::format("{:.3f}", d.dice_half), fmt::format("{:.3f}", d.dice_same_time), percent(d.floor_time),
                        percent(d.nudged_time), percent(d.gentle_time), fmt::format("{:.3f}", d.gentle_dice), explained(d, question)});
  return rows;
}

std::size_t count_missed(const std::vector<CaseResult>& results) {
  std::size_t count = 0;
  for (const CaseResult& r : results)
    for (const Difference& d : r.differences) count += d.missed;
  return count;
}

void print_json(const std::vector<CaseResult>& results, const TimeStepQuestion& question) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const CaseResult& r : results)
    for (const Difference& d : r.differences)
      list.push_back({{"material", r.which.material},
                      {"load", r.which.load},
                      {"pattern", r.which.pattern},
                      {"cfl", d.cfl},
                      {"rule", d.rule},
                      {"reference_rule", d.reference_rule},
                      {"time", d.time},
                      {"stress_drop", d.drop},
                      {"peak", d.peak},
                      {"dice_half", d.dice_half},
                      {"dice_open", d.dice_open},
                      {"missed", d.missed},
                      {"dice_same_time", d.dice_same_time},
                      {"floor_time", d.floor_time},
                      {"nudged_time", d.nudged_time},
                      {"ramped_time", d.gentle_time},
                      {"ramped_dice", d.gentle_dice},
                      {"what", d.missed ? explained(d, question) : ""}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.time_step/1"},
                          {"reference_cfl", question.reference},
                          {"time_limit", question.time_limit},
                          {"dice_limit", question.dice_limit},
                          {"ramp", question.choice.ramp},
                          {"missed", count_missed(results)},
                          {"runs", list}}
                         .dump(2));
}

}  // namespace

int time_step(const TimeStepQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<CaseResult> results(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { results[k] = solve_case(cases[k], question); });
  const std::size_t missed = count_missed(results);
  if (question.json) {
    print_json(results, question);
  } else {
    fmt::print("against CFL {}; mean / median / largest, mean / least; ramp {} s\n{}\n", question.reference, question.choice.ramp,
               table_text(summary(results, question)));
    if (missed > 0)
      fmt::print(
          "same time: Dice of psi > 0.5 at the earlier of the two times; G_c: the reference against itself with G_c changed so much;\n"
          "ramped: both again with the load's velocity ramped over {} s\n{}\n",
          gentle_ramp, table_text(misses(results, question)));
    fmt::print("{} of {} runs are past {:.1f} % or below Dice {}\n", missed, cases.size() * question.cfl.size(),
               100.0 * question.time_limit, question.dice_limit);
  }
  return missed == 0 ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
