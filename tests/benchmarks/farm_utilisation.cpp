// fracfarm-farm-utilisation: how much of many slots works, in simulated time: jobs of 1 s on 2,500 slots, and what allocations that end
// take away. Prints what was measured beside what is wanted; ends with 1 where something misses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "tests/benchmarks/farm_in_time.hpp"

using namespace fracfarm;
using namespace fracfarm::benchmarks;

namespace {

constexpr double least_working = 99.5;  // % of the slot time, with jobs of 1 s
constexpr double most_lost = 0.1;       // % of the slot time, to limits

struct Figure {
  std::string farm, what;
  double measured = 0.0;
  std::string unit;
  std::optional<double> least = {}, most = {};  // no limit: for information

  bool good() const { return !(least && measured < *least) && !(most && measured > *most); }
  std::string wanted() const {
    return least ? fmt::format(">= {} {}", *least, unit) : most ? fmt::format("<= {} {}", *most, unit) : std::string();
  }
};
using Figures = std::vector<Figure>;

void run(FarmInTime& farm, const std::string& name) {
  SystemClock clock;
  ProgressLine line;
  const double began_s = clock.monotonic_s(), began_cpu_s = process_cpu_s();
  farm.run([&](double now_s, double end_s) {
    const double elapsed_s = clock.monotonic_s() - began_s;
    if (elapsed_s > 2.0)
      line.show(fmt::format("{}: {} of {} simulated · {} left", name, duration_text(now_s), duration_text(end_s),
                            duration_text(elapsed_s * (end_s - now_s) / std::max(1e-9, now_s))));
  });
  line.finish(fmt::format("{}: {} jobs in {:.1f} s of CPU", name, farm.done(), process_cpu_s() - began_cpu_s));
}

Figures short_jobs(FarmPlan plan) {
  int slots = 0;
  for (int n = 0; n < plan.workers; ++n) slots += plan.kinds[static_cast<std::size_t>(n) % plan.kinds.size()].slots;
  const std::string name = fmt::format("{} slots, jobs of {:g} s", slots, plan.classes.front().mean_s);
  FarmInTime farm(plan);
  run(farm, name);
  const SlotTime& time = farm.slot_time();
  return {{name, "slot time that works", 100.0 * time.working / time.all(), "%", least_working, {}},
          {name, "jobs a second", static_cast<double>(farm.done()) / plan.counted_s, "1/s"},
          {name, "faults", static_cast<double>(farm.faults()), "", {}, 0.0}};
}

// Classes of different run times on nodes of two kinds.
Figures limits(FarmPlan plan) {
  const double long_s = plan.allocation_s / 16.0;
  plan.classes = {{"pbx", 2.0, 0.3}, {"steel", 60.0, 0.4}, {"tungsten", long_s, 0.4}};
  plan.kinds = {{25, std::uint64_t{1} << 36, 1.0}, {10, std::uint64_t{1} << 38, 0.6}};
  plan.wall_budget_s = 0.5 * plan.allocation_s;
  const std::string name = fmt::format("jobs of 2 s, 1 min, {}; allocations of {} to {}", duration_text(long_s),
                                       duration_text(0.5 * plan.allocation_s), duration_text(plan.allocation_s));
  FarmInTime farm(plan);
  run(farm, name);
  const SlotTime& time = farm.slot_time();
  const auto percent = [&](double seconds) { return 100.0 * seconds / time.all(); };
  return {{name, "slot time lost to limits", percent(time.cut + time.unfit), "%", {}, most_lost},
          {name, "... in tries that were cut", percent(time.cut), "%"},
          {name, "... idle, as nothing fits what is left", percent(time.unfit), "%"},
          {name, "slot time that works", percent(time.working), "%", least_working, {}},
          {name, "slot time given back early", percent(farm.given_back_s()), "%"},
          {name, "jobs done", static_cast<double>(farm.done()), "", 100.0, {}},
          {name, "tries cut", static_cast<double>(farm.cut()), ""},
          {name, "jobs given back", static_cast<double>(farm.planned_stops()), ""},
          {name, "allocations ended", static_cast<double>(farm.allocations()), "", 1.0, {}},
          {name, "retries burnt", static_cast<double>(farm.faults()), "", {}, 0.0}};
}

void print(const Figures& rows) {
  std::vector<std::vector<std::string>> table{{"farm", "what", "measured", "wanted", ""}};
  for (const Figure& it : rows)
    table.push_back({&it == &rows.front() || it.farm != (&it - 1)->farm ? it.farm : "", it.what,
                     fmt::format("{:.6g} {}", it.measured, it.unit), it.wanted(),
                     it.wanted().empty() ? ""
                     : it.good()         ? "good"
                                         : ink("missed", Ink::red, stdout)});
  fmt::print("{}", table_text(table));
}

void print_json(const Figures& rows, bool good) {
  nlohmann::json all = nlohmann::json::array();
  for (const Figure& it : rows) {
    nlohmann::json row{{"farm", it.farm}, {"what", it.what}, {"measured", it.measured}, {"unit", it.unit}, {"good", it.good()}};
    if (it.least) row["at_least"] = *it.least;
    if (it.most) row["at_most"] = *it.most;
    all.push_back(row);
  }
  fmt::print("{}\n", nlohmann::json{{"schema", "fracfarm.farm_utilisation/1"}, {"good", good}, {"rows", all}}.dump(2));
}

}  // namespace

int main(int argc, char** argv) {
  FarmPlan quick, ending;
  quick.classes = {{"pbx", 1.0, 0.3}};
  ending.workers = 40;
  ending.allocation_s = 4.0 * 3600.0;
  ending.warm_up_s = 4.0 * 3600.0;
  ending.counted_s = 24.0 * 3600.0;
  bool only_short = false, only_limits = false, json = false;
  CLI::App app{"How much of many slots works: real reactor, sessions and ledger in simulated time.", "fracfarm-farm-utilisation"};
  app.add_option("--workers", quick.workers, "of 25 slots each, with short jobs")->capture_default_str();
  app.add_option("--seconds", quick.counted_s, "simulated, of short jobs, after the warm-up")->capture_default_str();
  app.add_option("--mean", quick.classes[0].mean_s, "seconds of a short job")->capture_default_str();
  app.add_option("--ending-workers", ending.workers, "of 25 and 10 slots, whose allocations end")->capture_default_str();
  app.add_option("--allocation", ending.allocation_s, "seconds of an allocation: half of it to all of it")->capture_default_str();
  app.add_option("--ending-seconds", ending.counted_s, "simulated, of allocations that end, after the warm-up")->capture_default_str();
  auto* one = app.add_flag("--short-jobs", only_short, "only these");
  app.add_flag("--limits", only_limits, "only allocations that end")->excludes(one);
  app.add_flag("--json", json, "as JSON");
  CLI11_PARSE(app, argc, argv);
  Figures rows;
  if (!only_limits) rows = short_jobs(quick);
  if (!only_short)
    for (Figure& row : limits(ending)) rows.push_back(std::move(row));
  const bool good = std::all_of(rows.begin(), rows.end(), [](const Figure& row) { return row.good(); });
  json ? print_json(rows, good) : print(rows);
  return good ? 0 : 1;
}
