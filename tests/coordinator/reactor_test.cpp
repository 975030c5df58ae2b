#include "coordinator/reactor.hpp"

#include <catch2/catch.hpp>

#include "common/scene/parse.hpp"
#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using wire::Receipt;
using wire::Ruling;

TEST_CASE("An assignment is the campaign's scene under the job's key") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  CHECK(job_key(it.scene, build) == it.key);
  CHECK(it.wall_budget_s == 3600.0);
  CHECK(it.attempt == 1);
}

TEST_CASE("No job is handed out twice, and leases never repeat, also over restarts") {
  Farm farm(4);
  farm.hello("worker-a", "n1");
  const wire::Assignment first = farm.one("worker-a");
  farm.start();
  farm.hello("worker-a", "n1", "i1", {held(first)});
  const wire::Assignment second = farm.one("worker-a");
  CHECK(second.key != first.key);
  CHECK_FALSE(second.lease == first.lease);
  CHECK(second.lease.epoch > first.lease.epoch);
}

TEST_CASE("The same request twice gets the same reply and does nothing again") {
  Farm farm(4);
  farm.hello("worker-a", "n1");
  const auto once = std::get<wire::Jobs>(farm.tell("worker-a", wire::Next{{}, {}, {}, 1, -1.0}, 77));
  const auto twice = std::get<wire::Jobs>(farm.tell("worker-a", wire::Next{{}, {}, {}, 1, -1.0}, 77));
  CHECK(once.assignments.at(0).lease == twice.assignments.at(0).lease);
  CHECK(leased_jobs(farm.ledger.reading()).size() == 1);
}

TEST_CASE("A worker that nobody has greeted is asked to say hello") {
  Farm farm(1);
  const auto refusal = std::get<wire::Refusal>(farm.tell("worker-a", wire::Next{{}, {}, {}, 1, -1.0}));
  CHECK(refusal.reason.find("HELLO") != std::string::npos);
}

TEST_CASE("A restarted coordinator adopts the leases that workers still hold and recomputes nothing") {
  Farm farm(2);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.start();
  const auto welcome = std::get<wire::Welcome>(farm.hello("worker-a", "n1", "i1", {held(it)}));
  CHECK(welcome.rulings == std::vector{Ruling::adopt});
  CHECK(farm.complete("worker-a", result_of(it)) == Receipt::accepted);
  CHECK(farm.job(it.job).attempts == 1);
}

TEST_CASE("A lease under another key, of another peer or long over is abandoned") {
  Farm farm(2);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  wire::HeldLease other_key = held(it);
  other_key.key = digest_of("other");
  CHECK(farm.beat("worker-a", {other_key}).rulings == std::vector{Ruling::abandon});
  CHECK(std::get<wire::Welcome>(farm.hello("worker-b", "n2", "i2", {held(it)})).rulings == std::vector{Ruling::abandon});
  farm.pass(31.0);
  CHECK(farm.beat("worker-b", {held(it)}).rulings == std::vector{Ruling::abandon});
}

TEST_CASE("Each worker holds what it was given") {
  Farm farm(2);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment a = farm.one("worker-a"), b = farm.one("worker-b");
  CHECK(farm.beat("worker-a", {held(a)}).rulings == std::vector{Ruling::adopt});
  CHECK(farm.beat("worker-b", {held(b)}).rulings == std::vector{Ruling::adopt});
  CHECK(farm.beat("worker-a", {held(b)}).rulings == std::vector{Ruling::abandon});
}

TEST_CASE("A new start of a worker that does not list its leases loses them, once") {
  Farm farm(2);
  farm.hello("worker-a", "n1", "i1");
  const wire::Assignment it = farm.one("worker-a");
  farm.hello("worker-a", "n1", "i2");
  farm.hello("worker-a", "n1", "i3");
  CHECK(farm.job(it.job).state == State::retry_wait);
  REQUIRE(attempts_of(farm.ledger.reading(), farm.job(it.job).id).size() == 1);
  CHECK(attempts_of(farm.ledger.reading(), farm.job(it.job).id)[0].fault == "NODE_LOST");
}

TEST_CASE("A new start that lists an earlier lease keeps it") {
  Farm farm(2);
  farm.hello("worker-a", "n1", "i1");
  const wire::Assignment it = farm.one("worker-a");
  CHECK(std::get<wire::Welcome>(farm.hello("worker-a", "n1", "i2", {held(it)})).rulings == std::vector{Ruling::adopt});
  CHECK(farm.complete("worker-a", result_of(it)) == Receipt::accepted);
}

TEST_CASE("Jobs whose assignment was lost on the way come back with nothing counted") {
  Farm farm(1);
  farm.hello("worker-a", "n1", "i1");
  const wire::Assignment it = farm.one("worker-a");
  farm.hello("worker-a", "n1", "i1");
  CHECK(farm.job(it.job).state == State::ready);
  CHECK(attempts_of(farm.ledger.reading(), farm.job(it.job).id).empty());
}

TEST_CASE("A lease without beats ends after its timeout, one with beats does not") {
  Farm farm(2);
  farm.hello("worker-a", "n1");
  const wire::Assignment silent = farm.one("worker-a"), beaten = farm.one("worker-a");
  for (int n = 0; n < 8; ++n) {
    farm.pass(5.0);
    farm.beat("worker-a", {held(beaten)});
  }
  CHECK(farm.job(silent.job).state != State::leased);
  CHECK(farm.job(beaten.job).state == State::leased);
}

TEST_CASE("A coordinator that was away itself lets nobody's lease end for it and forgets nobody") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.tick(3600.0);
  CHECK(farm.job(it.job).state == State::leased);
  CHECK(farm.beat("worker-a", {held(it)}).rulings == std::vector{wire::Ruling::adopt});
  farm.pass(32.0);
  CHECK(farm.job(it.job).state != State::leased);
}

TEST_CASE("After a restart each lease has the full grace") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.pass(25.0);
  farm.start();
  farm.pass(25.0);
  CHECK(farm.job(it.job).state == State::leased);
  farm.pass(6.0);
  CHECK(farm.job(it.job).state == State::retry_wait);
}

TEST_CASE("The first valid result wins, from whichever lease, and the other holder is told to stop") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment first = farm.one("worker-a");
  farm.pass(34.0);
  farm.hello("worker-b", "n2");
  const wire::Assignment second = farm.one("worker-b");
  REQUIRE(second.key == first.key);
  CHECK(farm.complete("worker-a", result_of(first)) == Receipt::accepted);
  CHECK(farm.beat("worker-b", {held(second)}).rulings == std::vector{Ruling::abandon});
  CHECK(farm.complete("worker-b", result_of(second)) == Receipt::duplicate);
  CHECK(farm.job(first.job).outcome->sha256 == digest_of("record"));
}

TEST_CASE("A result whose acknowledgement was lost in a crash is accepted again, not called a duplicate") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  farm.start();
  farm.hello("worker-a", "n1");
  CHECK(farm.complete("worker-a", result_of(it)) == Receipt::accepted);
  CHECK(count_rows(farm.ledger.reading()).at(0).n == 1);
}

TEST_CASE("Two results of one key that differ raise an alarm that status shows; the same physics in other bytes does not") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  CHECK(farm.complete("worker-a", result_of(it, "written at another time")) == Receipt::duplicate);
  CHECK(farm.ask("status", nlohmann::json::object())["alarms"].empty());
  wire::Completion differs = result_of(it, "other physics");
  differs.peak_stress *= 1.0 + 1e-15;
  CHECK(farm.complete("worker-a", differs) == Receipt::duplicate);
  const auto alarms = farm.ask("status", nlohmann::json::object())["alarms"];
  REQUIRE(alarms.size() == 1);
  CHECK(alarms[0]["kind"] == "NONDETERMINISM");
}

TEST_CASE("A result that is not one is refused and its lease counts as OUTPUT_BAD") {
  Farm farm(8);
  farm.hello("worker-a", "n1", "i1", {}, 8);
  const wire::Jobs jobs = farm.claim("worker-a", 8);
  const std::vector<std::function<void(wire::Completion&)>> mistakes{
      [](auto& it) { it.time_to_failure = NAN; },  [](auto& it) { it.time_to_failure.reset(); },
      [](auto& it) { it.sha256 = "zz"; },          [](auto& it) { it.shard = "../../etc/passwd"; },
      [](auto& it) { it.shard.clear(); },          [](auto& it) { it.offset = ~0ull; },
      [](auto& it) { it.peak_stress = INFINITY; }, [](auto& it) { it.length = 0; }};
  for (std::size_t at = 0; at < mistakes.size(); ++at) {
    wire::Completion result = result_of(jobs.assignments.at(at));
    mistakes[at](result);
    INFO("mistake " << at);
    CHECK(farm.complete("worker-a", result) == Receipt::refused);
    CHECK(farm.job(jobs.assignments[at].job).state == State::retry_wait);
    CHECK(attempts_of(farm.ledger.reading(), farm.job(jobs.assignments[at].job).id).at(0).fault == "OUTPUT_BAD");
  }
}

TEST_CASE("A result for a key that is not here, or of an epoch to come, is refused") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  wire::Completion result = result_of(farm.one("worker-a"));
  wire::Completion unknown = result;
  unknown.key = digest_of("unknown");
  CHECK(farm.complete("worker-a", unknown) == Receipt::refused);
  result.lease.epoch += 5;
  CHECK(farm.complete("worker-a", result) == Receipt::refused);
}

TEST_CASE("Only the current lease can fail or return a job") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment it = farm.one("worker-a");
  CHECK(farm.fail_with("worker-b", it, Fault::solver_crash) == Receipt::stale);
  farm.next("worker-b", {{}, {}, {it.lease}, 0, -1.0});
  CHECK(farm.job(it.job).state == State::leased);
  CHECK(farm.fail_with("worker-a", it, Fault::solver_crash) == Receipt::accepted);
  CHECK(farm.fail_with("worker-a", it, Fault::solver_crash) == Receipt::stale);
}

TEST_CASE("A fault of an earlier lease says nothing about the current one, also from the same worker") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment old = farm.one("worker-a");
  farm.pass(34.0);
  const wire::Assignment current = farm.one("worker-a");
  REQUIRE(current.key == old.key);
  CHECK(farm.fail_with("worker-a", old, Fault::solver_crash) == Receipt::stale);
  CHECK(farm.job(current.job).state == State::leased);
}

TEST_CASE("A planned stop burns no retry, however often") {
  Farm farm(1, R"({"wall_clock": "1h", "attempts": 1})");
  farm.hello("worker-a", "n1");
  for (int n = 0; n < 20; ++n) {
    const wire::Assignment it = farm.one("worker-a");
    farm.next("worker-a", {{}, {}, {it.lease}, 0, -1.0});
    REQUIRE(farm.job(it.job).state == State::ready);
  }
  const wire::Assignment last = farm.one("worker-a");
  farm.tell("worker-a", wire::Bye{{last.lease}});
  CHECK(farm.job(last.job).state == State::ready);
}

TEST_CASE("A job that waits is ready again after its time, on another node where there is one") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment it = farm.one("worker-a");
  farm.fail_with("worker-a", it, Fault::solver_crash);
  CHECK(farm.claim("worker-b", 1).assignments.empty());
  farm.pass(2.0);
  CHECK(farm.claim("worker-a", 1).assignments.empty());
  const wire::Jobs again = farm.claim("worker-b", 1);
  REQUIRE(again.assignments.size() == 1);
  CHECK(again.assignments[0].attempt == 2);
}

TEST_CASE("A diverged job comes again with half the step, then is quarantined with its evidence") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_numeric, "not finite");
  farm.pass(2.0);
  const wire::Assignment half = farm.one("worker-a");
  CHECK(half.step_scale == 0.5);
  farm.fail_with("worker-a", half, Fault::solver_numeric, "not finite");
  CHECK(farm.job(half.job).state == State::quarantined);
  const auto said = farm.ask("explain", {{"job", std::to_string(half.job)}});
  CHECK(said["history"].size() == 2);
  CHECK(said["why"].get<std::string>().find("SOLVER_NUMERIC") != std::string::npos);
}

TEST_CASE("Five fast faults in a row stop a worker's claims; a result between them does not let it come to that") {
  Farm farm(40);
  farm.hello("worker-a", "n1");
  for (int n = 0; n < 4; ++n) farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash);
  farm.complete("worker-a", result_of(farm.one("worker-a")));
  for (int n = 0; n < 5; ++n) farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash);
  const wire::Jobs none = farm.claim("worker-a", 1);
  CHECK(none.assignments.empty());
  CHECK(none.order == wire::Order::wait);
  CHECK(farm.ask("status", nlohmann::json::object())["workers"][0]["state"] == "stopped");
  farm.hello("worker-a", "n1", "i2");
  CHECK(farm.claim("worker-a", 1).assignments.size() == 1);
}

TEST_CASE("Tries that fail together, as when a batch finds the disk full, are one fault in a row") {
  Farm farm(40);
  farm.hello("worker-a", "n1", "i1", {}, 8);
  for (int n = 0; n < 4; ++n) {
    wire::Next next{{}, {}, {}, 0, -1.0};
    for (const wire::Assignment& it : farm.claim("worker-a", 8).assignments)
      next.failed.push_back({it.lease, it.key, Fault::node_lost, "no space left", "s"});
    REQUIRE(next.failed.size() > 1);
    farm.next("worker-a", next);
  }
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::node_lost);
  CHECK(farm.claim("worker-a", 1).assignments.empty());
}

TEST_CASE("A worker of another solver build is refused in words") {
  Farm farm(1);
  const auto reply = farm.tell("worker-a", wire::Hello{"n1", "i1", 1, 1, "build-b", -1.0, {}});
  REQUIRE(std::holds_alternative<wire::Refusal>(reply));
  CHECK(std::get<wire::Refusal>(reply).reason.find("build-b") != std::string::npos);
  CHECK(std::get<wire::Refusal>(reply).reason.find("build-a") != std::string::npos);
}

TEST_CASE("A worker that came before the campaign is refused work of another build when it asks") {
  Farm farm(0);
  REQUIRE(std::holds_alternative<wire::Welcome>(farm.tell("worker-a", wire::Hello{"n1", "i1", 1, 1, "build-b", -1.0, {}})));
  farm.submit(campaign_text(1));
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("worker-a", wire::Next{{}, {}, {}, 1, -1.0})));
}

TEST_CASE("Work that does not fit the time left is kept for another") {
  Farm farm(2);
  farm.hello("worker-a", "n1");
  CHECK(farm.claim("worker-a", 1, 3000.0).assignments.empty());
  CHECK(farm.claim("worker-a", 1, 3700.0).assignments.size() == 1);
}

TEST_CASE("Nothing left is stop, a job elsewhere is wait, a drained worker is told so") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment it = farm.one("worker-a");
  CHECK(farm.claim("worker-b", 1).order == wire::Order::wait);
  farm.ask("drain", {{"workers", {"worker-b"}}});
  CHECK(farm.claim("worker-b", 1).order == wire::Order::drain);
  CHECK(farm.beat("worker-b", {}).order == wire::Order::drain);
  CHECK(farm.beat("worker-a", {held(it)}).order == wire::Order::none);
  farm.complete("worker-a", result_of(it));
  CHECK(farm.claim("worker-a", 1).order == wire::Order::stop);
}

TEST_CASE("A cancelled job's holder is told to stop, and its late result is stale") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.ask("cancel", {{"jobs", {it.job}}});
  CHECK(farm.beat("worker-a", {held(it)}).rulings == std::vector{Ruling::abandon});
  CHECK(farm.complete("worker-a", result_of(it)) == Receipt::stale);
  CHECK(farm.job(it.job).state == State::cancelled);
}

TEST_CASE("No worker hoards jobs, whatever it asks for") {
  Farm farm(most_jobs_a_slot + 10);
  farm.hello("worker-a", "n1", "i1", {}, 1);
  CHECK(farm.claim("worker-a", 1 << 30).assignments.size() == most_jobs_a_slot);
  CHECK(farm.claim("worker-a", -3).assignments.empty());
}

TEST_CASE("A rejected scene is a result without a record") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  CHECK(farm.complete("worker-a", {it.lease, it.key, Verdict::rejected, {}, "cells below 8", 0.0, 0, 0.0, 0.0, "", 0, 0, ""}) ==
        Receipt::accepted);
  CHECK(farm.job(it.job).outcome->verdict == Verdict::rejected);
}

TEST_CASE("Notices tell what somebody should know of: a quarantined job, and the end") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::bad_request);
  farm.tick(1.0);
  const std::vector<Notice> notices = farm.reactor->take_notices();
  REQUIRE(notices.size() == 2);
  CHECK(notices[0].kind == "quarantined");
  CHECK(notices[0].job == 1);
  CHECK(notices[1].kind == "settled");
}
