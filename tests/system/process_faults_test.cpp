// Processes that die at any call, stand still, or come twice; a ledger that is put back from an old copy. Campaigns of drills that do
// nothing, so that what is tested is the farm.
#include <signal.h>

#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "tests/system/mishap.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

namespace {

// A campaign of 20 jobs in which `program` dies at this call of its life; true where it came to it.
bool campaign_with_a_death(const std::string& program, int call) { return drills_with_a_mishap(20, {program, call}); }

struct Victim {
  const char* program;
  int calls;  // of a whole campaign, about
};
constexpr Victim victims[]{{"fracfarm-coordinator", 600}, {"fracfarm-worker", 700}, {"fracfarm-solve", 130}};

}  // namespace

TEST_CASE("coordinator, worker and solver killed at calls all over a campaign lose nothing and leave nothing undone") {
  const int each = from_environment("FRACFARM_KILLS", 3);  // a day's run: 700
  RandomStream random(static_cast<std::uint64_t>(from_environment("FRACFARM_KILL_SEED", 21)), 1, 1);
  int all_deaths = 0;
  for (const Victim& victim : victims) {
    int deaths = 0;
    for (int n = 0; n < each; ++n) {
      const int call = victim.calls * n / each + random.integer(0, std::max(1, victim.calls / each) - 1);
      INFO(victim.program << " killed at call " << call);
      deaths += campaign_with_a_death(victim.program, call);
    }
    WARN(victim.program << ": " << deaths << " deaths in " << each << " campaigns, no promise broken");
    all_deaths += deaths;
  }
  CHECK(all_deaths > 0);
}

TEST_CASE("a worker that stands still past its leases and goes on repeats nobody's result and breaks none") {
  FarmBench farm;
  constexpr int jobs = 12;
  submit_drills(farm, jobs, 0.4);
  Process coordinator = farm.coordinator({"--until-done", "--lease-timeout", "1"});
  Process still = farm.worker({"--slots", "2"});
  REQUIRE(wait_until([&] { return farm.logged("\"started\""); }));
  still.signal(SIGSTOP);
  Process other = farm.worker({"--slots", "2", "--once"});
  REQUIRE(wait_until([&] { return farm.done() >= jobs / 2; }));
  still.signal(SIGCONT);
  REQUIRE(wait_until([&] { return farm.done() == jobs || !coordinator.running(); }));
  still.signal(SIGTERM);
  CHECK(other.wait() == 0);
  CHECK(still.wait() == 3);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(jobs);
}

// Nobody asks it anything meanwhile: a verb waits half a minute for an answer.
TEST_CASE("a coordinator that stands still past the leases takes them from nobody when it goes on") {
  FarmBench farm;
  constexpr int jobs = 20;
  submit_drills(farm, jobs, 0.4);
  Process coordinator = farm.coordinator({"--until-done", "--lease-timeout", "1"});
  Process worker = farm.worker({"--slots", "2", "--once"});
  REQUIRE(wait_until([&] { return farm.logged("\"started\""); }));
  coordinator.signal(SIGSTOP);
  sleep_s(3.0);
  coordinator.signal(SIGCONT);
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(jobs);
  for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
}

TEST_CASE("a second coordinator on one ledger is refused in words, and the first goes on") {
  FarmBench farm;
  submit_drills(farm, 2);
  Process first = farm.coordinator({"--until-done"});
  REQUIRE(wait_until([&] { return std::filesystem::exists(farm.farm() / "endpoint.json"); }));
  const auto second = farm.verb({"coordinator"});
  CHECK(second.status == 4);
  CHECK(second.output.find("held by another process") != std::string::npos);
  Process worker = farm.worker({"--slots", "1", "--once"});
  CHECK(worker.wait() == 0);
  CHECK(first.wait() == 0);
  farm.check_all_done(2);
}

TEST_CASE("an old copy of the ledger beside newer shards is put back without computing anything twice") {
  FarmBench farm;
  constexpr int jobs = 10;
  submit_drills(farm, jobs);
  const auto copy = farm.folder() / "copy.db";
  REQUIRE(farm.verb({"backup", copy.string()}).status == 0);
  {
    Process coordinator = farm.coordinator({"--until-done"});
    Process worker = farm.worker({"--slots", "2", "--once"});
    CHECK(worker.wait() == 0);
    CHECK(coordinator.wait() == 0);
  }
  farm.check_all_done(jobs);
  const auto restored = farm.verb({"restore", copy.string()});
  INFO(restored.output);
  CHECK(restored.status == 0);
  Process coordinator = farm.coordinator({"--until-done"});
  Process worker = farm.worker({"--slots", "2", "--once"});
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(jobs);
  for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
}

TEST_CASE("a question that a coordinator leaves without an answer, as it ends, is answered from its ledger") {
  FarmBench farm;
  submit_drills(farm, 3);
  Process coordinator = farm.coordinator({});
  REQUIRE(wait_until([&] { return farm.json({"status"})["serving"].get<bool>(); }));
  coordinator.signal(SIGSTOP);
  Process question = farm.start({"status", "--json"});
  sleep_s(1.0);
  CHECK(question.running());
  coordinator.signal(SIGKILL);
  CHECK(question.wait(20.0) == 0);
}
