// A worker's and a solver's disk that is full, fails, or forgets what was not synced, at calls all over a campaign: nothing is acknowledged
// that does not lie in a shard, and when the trouble is over every job comes to be DONE. The ledger's disk is the simulation's business.
#include <signal.h>

#include <catch2/catch.hpp>

#include "tests/system/mishap.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

namespace {

constexpr const char* troubles[]{"ENOSPC", "EIO", "short write", "lost unsynced writes"};

struct Place {
  const char* what;
  const char* program;
  const char* files;  // part of their paths
  int sure_write;     // the number of a write that every campaign comes to; what is synced together is one write of the outbox
};
constexpr Place places[]{
    {"shards", "fracfarm-worker", "/store", 2}, {"outbox", "fracfarm-worker", "/outbox", 0}, {"records", "fracfarm-solve", ".h5", 2}};

// A day's run: 1, and every call of a campaign has its turn. 0: one call.
int every() { return from_environment("FRACFARM_TROUBLE_EVERY", 0); }

// How many calls had it: up to the first that no campaign came to.
int calls_with(const Place& place, const std::string& trouble) {
  int calls = 0;
  const int one = trouble == "short write" ? place.sure_write : 2;
  for (int call = every() > 0 ? 0 : one;; call += every()) {
    INFO(place.what << ": " << trouble << " at call " << call);
    if (!drills_with_a_mishap(10, {place.program, call, trouble, place.files})) return calls;
    ++calls;
    if (every() <= 0) return calls;
  }
}

}  // namespace

TEST_CASE("a worker's disk that is full, fails or forgets costs tries and nothing else") {
  for (const Place& place : places)
    for (const char* trouble : troubles) {
      const int calls = calls_with(place, trouble);
      WARN(place.what << ": " << trouble << " at " << calls << " calls, no promise broken");
      CHECK(calls > 0);
    }
}

TEST_CASE("a checkpoint that the disk does not take, or loses, costs the work that it held and nothing else") {
  for (const char* trouble : troubles)
    for (int call = 1; call < (every() > 0 ? 6 : 2); ++call) {
      INFO(trouble << " at call " << call);
      FarmBench farm;
      farm.submit({.patterns = 1, .set = R"("phase_field.cells" = [383, 383])"});  // long enough to be stopped
      Process coordinator = farm.coordinator({"--until-done", "--lease-timeout", "2"});
      Process first = farm.worker({"--slots", "1"}, environment_of(farm, {"fracfarm-solve", call, trouble, "/checkpoints"}));
      REQUIRE(wait_until([&] { return farm.logged("\"progress\""); }));
      first.signal(SIGTERM);
      CHECK(first.wait() == 3);
      Process second = farm.worker({"--slots", "1", "--once"});
      CHECK(second.wait() == 0);
      CHECK(coordinator.wait() == 0);
      farm.check_all_done(1);
    }
}
