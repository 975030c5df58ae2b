#include <catch2/catch.hpp>

#include "tests/simulation/world.hpp"

using namespace fracfarm::simulation;

namespace {

constexpr std::uint64_t seeds = 200;

// The first seed whose world breaks an invariant that begins with `name`; 0 where none does.
std::uint64_t seed_that_breaks(KnownBug bug, const std::string& name) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    World world(seed, {.bug = bug});
    const std::vector<std::string> broken = world.run();
    if (!broken.empty()) return broken.front().rfind(name, 0) == 0 ? seed : 0;
  }
  return 0;
}

}  // namespace

TEST_CASE("The farm keeps its invariants whatever the network, the workers and the coordinator do") {
  std::uint64_t done = 0, faults = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    World world(seed, {});
    INFO("seed " << seed);
    const std::vector<std::string> broken = world.run();
    INFO((broken.empty() ? std::string("sound") : broken.front()));
    REQUIRE(broken.empty());
    done += world.done();
    faults += world.faults_seen();
  }
  CHECK(done > 9 * seeds);    // of 12 jobs, one of which always diverges and some of which are cancelled
  CHECK(faults > 5 * seeds);  // something did go wrong
}

TEST_CASE("The same seed gives the same trace") {
  World one(42, {}), same(42, {}), other(43, {});
  one.run();
  same.run();
  other.run();
  CHECK(one.trace_hash() == same.trace_hash());
  CHECK(one.trace_hash() != other.trace_hash());
}

TEST_CASE("The harness finds an acknowledgement before its commit") {
  CHECK(seed_that_breaks(KnownBug::acknowledge_before_commit, "I2") != 0);
}
TEST_CASE("The harness finds an epoch that is not raised at a start") { CHECK(seed_that_breaks(KnownBug::epoch_not_raised, "I4") != 0); }
TEST_CASE("The harness finds counters that drift") { CHECK(seed_that_breaks(KnownBug::counter_drift, "I5") != 0); }
TEST_CASE("The harness finds a result that is overwritten") { CHECK(seed_that_breaks(KnownBug::done_overwritten, "I1") != 0); }
