#include <catch2/catch.hpp>

#include <cstdio>

#include "common/base/clock.hpp"
#include "tests/simulation/world.hpp"

using namespace fracfarm;
using namespace fracfarm::simulation;

namespace {

constexpr std::uint64_t seeds = 1000;

std::string replay(std::uint64_t seed) { return "replay it with: fracfarm-simulate --seed " + std::to_string(seed) + " --tell"; }

}  // namespace

TEST_CASE("The farm keeps its invariants whatever network, disks, clocks and processes do") {
  const double began_s = process_cpu_s();
  std::uint64_t done = 0, faults = 0, looks = 0, steps = 0;
  double simulated_s = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    World world(seed, {});
    const std::string broken = world.run();
    INFO("seed " << seed << "; " << replay(seed));
    REQUIRE(broken == "");
    done += world.watched().done();
    faults += world.watched().faults();
    looks += world.watched().looks();
    steps += world.steps();
    simulated_s += world.simulated_s();
  }
  const double cpu_s = process_cpu_s() - began_s;
  std::printf("%llu seeds, %llu steps, %llu states of the ledger: %.0f s of farm in %.1f s of CPU, %.0f times real time\n",
              static_cast<unsigned long long>(seeds), static_cast<unsigned long long>(steps), static_cast<unsigned long long>(looks),
              simulated_s, cpu_s, simulated_s / cpu_s);
  CHECK(done > 9 * seeds);    // of 12 jobs, one of which always diverges and some of which are cancelled
  CHECK(faults > 4 * seeds);  // something did go wrong
  CHECK(simulated_s > 100.0 * cpu_s);
}

TEST_CASE("The same seed gives the same trace") {
  World one(42, {}), other(43, {});
  one.run();
  other.run();
  World same(42, {});
  same.run();
  CHECK(one.trace_hash() == same.trace_hash());
  CHECK(one.trace_hash() != other.trace_hash());
}

TEST_CASE("Every classic error that is put back in is found within a thousand seeds, by the invariant that it breaks") {
  for (const KnownBugRow& row : known_bugs) {
    std::string broken;
    std::uint64_t seed = 1;
    for (; seed <= seeds && broken.empty(); ++seed) broken = World(seed, {.bug = row.bug}).run();
    std::printf("%-28s seed %4llu: %.100s\n", std::string(row.name).c_str(), static_cast<unsigned long long>(seed - 1), broken.c_str());
    INFO(row.name << ": " << broken);
    CHECK(broken.rfind(std::string(row.breaks) + ":", 0) == 0);
  }
}
