// The five-step pick: what running on until it exists costs beside a stop behind the stress drop, and whether the pick that is taken as
// settled is the one of a run to the horizon, with the settling rule as it is and with others.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/failure/failure_pick.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

constexpr Settling tried[]{{settling_wait, settling_quiet}, {0.1, 0.5}, {0.25, 0.25}, {0.25, 1.0}, {0.5, 0.5}, {1.0, 0.5}, {2.0, 0.5}};

// What a run sees that goes on until its pick is settled.
struct Settled {
  std::optional<double> at, pick;  // s
};

struct PickCase {
  Case which;
  std::string trouble;
  std::optional<double> drop10, pick;  // s, of the run to the horizon
  double horizon = 0.0;
  double drop_cpu_s = 0.0, failure_cpu_s = 0.0, horizon_cpu_s = 0.0;
  std::array<Settled, std::size(tried)> settled;
};

// The rows of a run to the horizon are those of a run that stops early, and more.
Settled settle(const Series& series, const Settling& settling) {
  FailurePick pick(settling);
  for (std::size_t row = 0; row < series.rows() && !pick.settled(); ++row)
    pick.add({series["step_time"][row], series["stress_zz"][row], series["total_stress"][row], series["kinetic_energy"][row]});
  return {pick.settled_at(), pick.five_step()};
}

PickCase solve_case(const Case& which, const FdemPickQuestion& question) {
  Scene scene = fdem_scene(which, question.choice.seed);
  const auto to = [&](Stop stop) {
    scene.stop = stop;
    return run_fdem(scene);
  };
  const FdemRun drop = to(Stop::drop10), failure = to(Stop::failure);
  if (drop.drop10) scene.horizon = std::min(scene.horizon, question.reach * *drop.drop10);
  const FdemRun all = to(Stop::horizon);
  PickCase one{which, drop.trouble + failure.trouble + all.trouble, all.drop10, all.five_step, all.last_time, 0.0, 0.0, 0.0, {}};
  if (!one.trouble.empty()) return one;
  one.drop_cpu_s = drop.cpu_s, one.failure_cpu_s = failure.cpu_s, one.horizon_cpu_s = all.cpu_s;
  for (std::size_t k = 0; k < std::size(tried); ++k) one.settled[k] = settle(all.series, tried[k]);
  return one;
}

struct Counts {
  std::size_t runs = 0, picks = 0, settled = 0, agree = 0, troubles = 0;
  Spread late, off, end_over_drop, pick_over_drop, drop_cpu, failure_cpu, horizon_cpu;
};

Counts count(const std::vector<PickCase>& cases, const std::string& material, std::size_t k) {
  Counts c;
  std::vector<double> late, off, end, pick, drop_cpu, failure_cpu, horizon_cpu;
  for (const PickCase& one : cases) {
    if (!material.empty() && one.which.material != material) continue;
    ++c.runs;
    if (!one.trouble.empty() || !one.drop10) {
      ++c.troubles;
      continue;
    }
    const Settled& s = one.settled[k];
    c.picks += one.pick.has_value(), c.settled += s.at.has_value(), c.agree += s.at && s.pick == one.pick;
    if (s.at) late.push_back(*s.at / *s.pick), off.push_back(apart(s.pick, one.pick).value_or(1.0));
    end.push_back(s.at.value_or(one.horizon) / *one.drop10);
    if (one.pick) pick.push_back(*one.pick / *one.drop10);
    drop_cpu.push_back(one.drop_cpu_s), failure_cpu.push_back(one.failure_cpu_s), horizon_cpu.push_back(one.horizon_cpu_s);
  }
  c.late = spread_of(late), c.off = spread_of(off), c.end_over_drop = spread_of(end), c.pick_over_drop = spread_of(pick);
  c.drop_cpu = spread_of(drop_cpu), c.failure_cpu = spread_of(failure_cpu), c.horizon_cpu = spread_of(horizon_cpu);
  return c;
}

void print_text(const std::vector<PickCase>& cases, const FdemPickQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"material", "runs", "pick", "settled", "the end's", "pick / drop10", "settled / pick",
                                              "end / drop10", "CPU s to 1.8 drop10", "to the pick", "to the end", "trouble"}};
  for (const std::string& material : question.choice.materials) {
    const Counts c = count(cases, material, 0);
    rows.push_back({material, std::to_string(c.runs), std::to_string(c.picks), std::to_string(c.settled), std::to_string(c.agree),
                    fmt::format("{:.2f} / {:.2f}", c.pick_over_drop.mean, c.pick_over_drop.most), fmt::format("{:.2f}", c.late.mean),
                    fmt::format("{:.2f}", c.end_over_drop.mean), fmt::format("{:.2f}", c.drop_cpu.mean),
                    fmt::format("{:.2f}", c.failure_cpu.mean), fmt::format("{:.2f}", c.horizon_cpu.mean), std::to_string(c.troubles)});
  }
  std::vector<std::vector<std::string>> other{{"wait", "quiet", "settled", "the end's", "off % (mean / largest)", "end / drop10"}};
  for (std::size_t k = 0; k < std::size(tried); ++k) {
    const Counts c = count(cases, "", k);
    other.push_back({fmt::format("{}", tried[k].wait), fmt::format("{}", tried[k].quiet), fmt::format("{} of {}", c.settled, c.runs),
                     std::to_string(c.agree), mean_most(c.off), fmt::format("{:.2f}", c.end_over_drop.mean)});
  }
  fmt::print("pick: of runs to {} drop10 or the horizon; settled: taken as settled before; the end's: settled on the same\n{}\n{}\n",
             question.reach, table_text(rows), table_text(other));
}

void print_json(const std::vector<PickCase>& cases) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json list = Json::array();
  for (const PickCase& one : cases) {
    Json settled = Json::array();
    for (std::size_t k = 0; k < std::size(tried); ++k)
      settled.push_back(
          {{"wait", tried[k].wait}, {"quiet", tried[k].quiet}, {"at", number(one.settled[k].at)}, {"pick", number(one.settled[k].pick)}});
    list.push_back({{"material", one.which.material},
                    {"pattern", one.which.pattern},
                    {"trouble", one.trouble},
                    {"drop10", number(one.drop10)},
                    {"pick", number(one.pick)},
                    {"drop_cpu_s", one.drop_cpu_s},
                    {"failure_cpu_s", one.failure_cpu_s},
                    {"horizon_cpu_s", one.horizon_cpu_s},
                    {"settled", settled}});
  }
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_pick/1"}, {"cases", list}}.dump(2));
}

}  // namespace

int fdem_pick(const FdemPickQuestion& question) {
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<PickCase> solved(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solved[k] = solve_case(cases[k], question); });
  question.json ? print_json(solved) : print_text(solved, question);
  return exit_ok;
}

}  // namespace fracfarm::studies
