// Blame, canaries, audits, repairs, the fuse and memory: what the reactor holds against nodes, results and classes.
#include <catch2/catch.hpp>

#include "coordinator/blame.hpp"
#include "coordinator/fuse.hpp"
#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using nlohmann::json;

namespace {

json status_of(Farm& farm) { return farm.ask("status", json::object()); }

std::string state_of(Farm& farm, const std::string& peer) {
  const json status = status_of(farm);
  for (const json& it : status["workers"])
    if (it["name"] == peer) return it["state"];
  return "gone";
}

// worker-a on n1 fails n jobs that worker-b on n2 then does.
void let_fail_on_n1(Farm& farm, int n) {
  for (int k = 0; k < n; ++k) {
    const wire::Assignment it = farm.one("worker-a");
    farm.fail_with("worker-a", it, Fault::solver_crash, "signal 11");
    farm.pass(2.0);
    const wire::Assignment again = farm.one("worker-b");
    REQUIRE(again.key == it.key);
    farm.complete("worker-b", result_of(again));
  }
}

}  // namespace

TEST_CASE("A node is blamed for failures of jobs that another node then did, and is suspect after three") {
  Farm farm(10);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  let_fail_on_n1(farm, 2);
  CHECK(state_of(farm, "worker-a") == "working");
  let_fail_on_n1(farm, 1);
  CHECK(state_of(farm, "worker-a") == "suspect");
  CHECK(state_of(farm, "worker-b") == "working");
  CHECK(status_of(farm)["suspects"][0]["node"] == "n1");
  CHECK(farm.ask("worker", {{"worker", "worker-a"}})["blamed"] == 3);
}

TEST_CASE("A suspect gets one canary, a job whose result is known, before other work; passing it clears the node") {
  Farm farm(10);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  let_fail_on_n1(farm, 3);
  const wire::Jobs canary = farm.claim("worker-a", 4);
  REQUIRE(canary.assignments.size() == 1);
  const wire::Assignment it = canary.assignments[0];
  CHECK(farm.job(it.job).state == State::done);
  CHECK(farm.claim("worker-a", 4).assignments.empty());  // one at a time
  CHECK(farm.beat("worker-a", {held(it)}).rulings == std::vector{wire::Ruling::adopt});
  CHECK(farm.complete("worker-a", result_of(it, "other bytes, same physics")) == wire::Receipt::duplicate);
  CHECK(farm.job(it.job).outcome->sha256 == digest_of("record"));
  CHECK(state_of(farm, "worker-a") == "working");
  CHECK(farm.claim("worker-a", 4).assignments.size() == 4);
}

TEST_CASE("A canary with another result raises an alarm and leaves the node without work; the next one comes after a pause") {
  Farm farm(10);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  let_fail_on_n1(farm, 3);
  const wire::Assignment it = farm.one("worker-a");
  wire::Completion wrong = result_of(it);
  wrong.peak_stress *= 1.0 + 1e-12;
  farm.complete("worker-a", wrong);
  CHECK(status_of(farm)["alarms"][0]["kind"] == "CANARY");
  CHECK(farm.claim("worker-a", 4).assignments.empty());
  CHECK(farm.claim("worker-b", 1).assignments.size() == 1);
  farm.pass(50.0);
  farm.hello("worker-a", "n1");
  CHECK(farm.claim("worker-a", 4).assignments.empty());
  farm.pass(12.0);
  CHECK(farm.claim("worker-a", 4).assignments.size() == 1);
}

TEST_CASE("Suspicion outlives a restart of the coordinator; fifty results after a blame forget it") {
  Farm farm(100);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  let_fail_on_n1(farm, 2);
  for (int n = 0; n < 50; ++n) farm.complete("worker-a", result_of(farm.one("worker-a")));
  CHECK(node_rows(farm.ledger.reading()).empty());
  let_fail_on_n1(farm, 3);
  farm.start();
  farm.hello("worker-a", "n1", "i2");
  CHECK(state_of(farm, "worker-a") == "suspect");
}

TEST_CASE("A worker stopped by fast faults works again when it does a job whose result another node gave") {
  Farm farm(40);
  farm.hello("worker-b", "n2");
  farm.complete("worker-b", result_of(farm.one("worker-b")));
  farm.tell("worker-b", wire::Bye{});
  farm.hello("worker-a", "n1");
  for (int n = 0; n < most_fast_faults; ++n) farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash);
  const wire::Assignment canary = farm.one("worker-a");
  CHECK(farm.job(canary.job).state == State::done);
  farm.complete("worker-a", result_of(canary));
  CHECK(farm.claim("worker-a", 1).assignments.size() == 1);
}

TEST_CASE("The fuse of a class blows at more than five percent of a thousand attempts, and not before") {
  Fuse fuse;
  for (std::size_t n = 0; n < 3 * fuse_window; ++n) REQUIRE_FALSE(fuse.blows(n % 20 == 0));
  CHECK_FALSE(fuse.blows(true));  // takes the place of one that failed a thousand attempts ago
  CHECK(fuse.blows(true));
  Fuse fresh;
  for (std::size_t n = 0; n < fuse_most_failed; ++n) REQUIRE_FALSE(fresh.blows(true));
  CHECK(fresh.blows(true));
  CHECK(fresh.last_seen() == fuse_most_failed + 1);
}

TEST_CASE("A class whose jobs fail is paused with words, the others go on, and resume lets it go on") {
  Farm farm(0);
  farm.submit(campaign_text(200));
  farm.hello("worker-a", "n1", "i1", {}, 1);
  farm.hello("worker-b", "n2", "i2", {}, 1);
  for (std::size_t n = 0; n <= fuse_most_failed; ++n)
    farm.fail_with(n % 2 ? "worker-a" : "worker-b", farm.one(n % 2 ? "worker-a" : "worker-b"), Fault::solver_numeric, "not finite");
  const json status = status_of(farm);
  REQUIRE(status["paused"].size() == 1);
  CHECK(status["paused"][0]["why"].get<std::string>().find("50") != std::string::npos);
  CHECK(status["alarms"][0]["kind"] == "FUSE");
  CHECK(farm.claim("worker-a", 1).assignments.empty());
  CHECK(farm.ask("explain", {{"job", "200"}})["why"].get<std::string>().find("paused") != std::string::npos);
  farm.start();  // a pause outlives a restart
  farm.hello("worker-a", "n1", "i3", {}, 1);
  CHECK(farm.claim("worker-a", 1).assignments.empty());
  CHECK(farm.ask("resume", {{"material", "pbx"}})["changed"] == 1);
  CHECK(farm.claim("worker-a", 1).assignments.size() == 1);
}

TEST_CASE("A job that ran out of memory goes to a node with more, is tried twice where there is none, and then set aside") {
  Farm farm(1);
  const auto hello = [&](const std::string& peer, const std::string& node, std::uint64_t memory) {
    farm.tell(peer, wire::Hello{node, "i-" + peer, 1, memory, build, -1.0, {}});
  };
  hello("small", "n1", 1u << 30);
  hello("large", "n2", 4u << 30);
  farm.fail_with("small", farm.one("small"), Fault::out_of_memory, "memory");
  farm.pass(3.0);
  CHECK(farm.claim("small", 1).assignments.empty());
  const wire::Assignment again = farm.one("large");
  farm.fail_with("large", again, Fault::out_of_memory, "memory");
  CHECK(farm.job(again.job).state == State::retry_wait);  // the same signature on two nodes is what memory looks like
  farm.pass(6.0);
  farm.fail_with("large", farm.one("large"), Fault::out_of_memory, "memory");
  CHECK(farm.job(again.job).state == State::quarantined);
}

TEST_CASE("A sample of the results is computed again on another node, and a difference raises the alarm") {
  Farm farm(3);
  farm.settings.audit_fraction = 1.0;
  farm.start();
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment first = farm.one("worker-a");
  farm.complete("worker-a", result_of(first));
  CHECK(farm.one("worker-a").key != first.key);  // not on the node that gave the result
  const wire::Jobs jobs = farm.claim("worker-b", 2);
  REQUIRE(jobs.assignments.size() == 2);
  REQUIRE(jobs.assignments[0].key == first.key);
  wire::Completion differs = result_of(jobs.assignments[0]);
  differs.steps += 1;
  CHECK(farm.complete("worker-b", differs) == wire::Receipt::duplicate);
  CHECK(status_of(farm)["alarms"][0]["kind"] == "NONDETERMINISM");
  CHECK(status_of(farm)["rechecks"]["AUDIT"]["DIFFERED"] == 1);
  CHECK(farm.job(first.job).outcome->steps == 180);
}

TEST_CASE("A repair takes the new bytes where the result is the same, keeps the old where not, and the farm is not settled before") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  CHECK(farm.reactor->settled());
  CHECK(farm.ask("recheck", {{"jobs", {it.job}}, {"repair", true}})["changed"] == 1);
  CHECK_FALSE(farm.reactor->settled());
  CHECK(farm.ask("recheck", {{"jobs", {it.job}}})["refused"].size() == 1);  // it is under way
  wire::Completion repaired = result_of(farm.one("worker-a"), "new bytes");
  repaired.shard = "shard-1.tar";
  CHECK(farm.complete("worker-a", repaired) == wire::Receipt::accepted);
  CHECK(farm.job(it.job).outcome->shard == "shard-1.tar");
  CHECK(farm.job(it.job).outcome->sha256 == digest_of("new bytes"));
  CHECK(farm.job(it.job).state == State::done);
  CHECK(farm.reactor->settled());
}

TEST_CASE("An audit whose worker is lost or that fails comes again, three times at most") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  farm.ask("recheck", {{"jobs", {it.job}}});
  for (int n = 0; n < 2; ++n) farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash);
  farm.next("worker-a", {{}, {}, {farm.one("worker-a").lease}, 0, -1.0});  // a planned stop counts nothing
  farm.one("worker-a");
  farm.pass(34.0);
  CHECK(status_of(farm)["rechecks"]["AUDIT"]["FAILED"] == 1);
  CHECK(farm.job(it.job).state == State::done);
  CHECK(farm.reactor->settled());
}

TEST_CASE("Only the failures of other nodes are blamed on them, each node once") {
  const auto row = [](Fault fault, const std::string& node) {
    AttemptRow it;
    it.fault = fault_row(fault).name;
    it.node = node;
    return it;
  };
  const std::vector<AttemptRow> history{row(Fault::solver_crash, "n1"), row(Fault::output_bad, "n1"), row(Fault::solver_numeric, "n3"),
                                        row(Fault::node_lost, "n2"), row(Fault::planned_stop, "n4")};
  CHECK(blamed_nodes(history, "n2") == std::vector<std::string>{"n1"});
  CHECK(blamed_nodes(history, "n9") == std::vector<std::string>{"n1", "n2"});
  CHECK(canary_pause_s(1) == 60.0);
  CHECK(canary_pause_s(3) == 240.0);
  CHECK(canary_pause_s(50) == longest_canary_pause_s);
}
