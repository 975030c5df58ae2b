// fracfarm-simulate: many seeds of the simulated farm, or one again. Prints a replay command for each seed that breaks an invariant.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "tests/simulation/disk_matrix.hpp"
#include "tests/simulation/world.hpp"

using namespace fracfarm;
using namespace fracfarm::simulation;

namespace {

struct Options {
  std::uint64_t first = 1, seeds = 1000;
  std::string bug;
  bool tell = false;
  std::uint64_t disk_every = 0;
};

void tell(std::uint64_t seed, const World& world, const std::string& broken) {
  fmt::print("seed {}: {} steps, {:.0f} s simulated, {} done, {} faults, trace {}: {}\n", seed, world.steps(), world.simulated_s(),
             world.watched().done(), world.watched().faults(), world.trace_hash(), broken.empty() ? "sound" : broken);
}

int simulate(const Options& options, const Settings& settings) {
  SystemClock clock;
  ProgressLine line;
  const double began_s = clock.monotonic_s(), began_cpu_s = process_cpu_s();
  double simulated_s = 0.0;
  std::uint64_t broken_seeds = 0;
  for (std::uint64_t n = 0; n < options.seeds; ++n) {
    const std::uint64_t seed = options.first + n;
    World world(seed, settings);
    const std::string broken = world.run();
    simulated_s += world.simulated_s();
    if (options.tell) tell(seed, world, broken);
    if (options.tell) std::fflush(stdout);
    if (!broken.empty()) {
      ++broken_seeds;
      fmt::print("seed {}: {}\n  replay it with: fracfarm-simulate --seed {}{} --tell\n", seed, broken, seed,
                 options.bug.empty() ? "" : " --bug " + options.bug);
      std::fflush(stdout);
    }
    const double elapsed_s = clock.monotonic_s() - began_s;
    if (elapsed_s > 2.0 && n % 16 == 0)
      line.show(fmt::format("seed {} of {} · {} broken · {} left", n + 1, options.seeds, broken_seeds,
                            duration_text(elapsed_s * static_cast<double>(options.seeds - n - 1) / static_cast<double>(n + 1))));
  }
  const double cpu_s = process_cpu_s() - began_cpu_s;
  line.finish(fmt::format("{} seeds, {} broken; {:.0f} s of farm in {:.1f} s of CPU, {:.0f} times real time", options.seeds, broken_seeds,
                          simulated_s, cpu_s, simulated_s / cpu_s));
  return broken_seeds == 0 ? 0 : 1;
}

int disk_troubles(std::uint64_t every) {
  std::uint64_t violations = 0;
  for (const MatrixRow& row : disk_matrix(every, [](const MatrixRow& it) {
         fmt::print("{}\n", text_of(it));
         std::fflush(stdout);
       }))
    violations += row.violations;
  return violations == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Runs the farm in simulation: the real reactor, sessions and ledger on a simulated network, disk and clock.",
               "fracfarm-simulate"};
  app.add_option("--seeds", options.seeds, "how many")->capture_default_str();
  app.add_option("--first", options.first, "the first seed")->capture_default_str();
  auto* one = app.add_option("--seed", options.first, "this one alone");
  app.add_option("--bug", options.bug, "put a classic error back in (tests/simulation/known_bugs.hpp)");
  app.add_option("--disk", options.disk_every, "instead: trouble at every n-th call of the disk in a campaign; 1 is every call");
  app.add_flag("--tell", options.tell, "a line for each seed; everything that happens where it is one");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) options.seeds = 1;
  if (options.disk_every > 0) return disk_troubles(options.disk_every);
  Settings settings;
  settings.tell = options.tell && options.seeds == 1;
  if (!options.bug.empty()) {
    const KnownBugRow* row = known_bug(options.bug);
    if (!row) return fmt::print(stderr, "error: --bug = {}: there is no such bug\n", options.bug), 2;
    settings.bug = row->bug;
  }
  return simulate(options, settings);
}
