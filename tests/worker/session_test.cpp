#include "worker/session.hpp"

#include <catch2/catch.hpp>

#include "tests/worker/session_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;
using namespace fracfarm::worker::bench;

TEST_CASE("a session greets, asks for its free slots and starts what it gets") {
  Bench bench;
  const auto next = bench.welcome_and_take_next();
  CHECK(next.free_slots == 2);
  bench.give({assignment(1), assignment(2)});
  REQUIRE(bench.started.size() == 2);
  CHECK(bench.started[1].assignment.key == "key2");
  CHECK(bench.posted.empty());  // nothing more to ask for
}

TEST_CASE("one request is under way at a time") {
  Bench bench;
  bench.after(10.0);
  bench.after(10.0);
  CHECK(bench.posted.size() == 1);
}

TEST_CASE("a kept record is reported with the request for more, and forgotten only when it is acknowledged") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  bench.solve(0);
  const auto request = bench.take<wire::Next>();
  // The slot was free before the record was kept: the first request may hold no completion yet.
  const auto report = request.completed.empty() ? (bench.give({}), bench.after(1.0), bench.take<wire::Next>()) : request;
  REQUIRE(report.completed.size() == 1);
  CHECK(report.completed[0].key == "key1");
  CHECK(bench.acknowledged.empty());
  bench.give({}, {wire::Receipt::accepted});
  CHECK(bench.acknowledged == std::vector<std::string>{"key1"});
}

TEST_CASE("WAIT is obeyed, and results do not wait for it") {
  Bench bench({.slots = 1});
  bench.welcome_and_take_next();
  wire::Jobs wait;
  wait.order = wire::Order::wait;
  wait.wait_s = 3.0;
  bench.reply(wait);
  bench.after(2.9);
  CHECK(bench.posted.empty());
  bench.after(0.2);
  CHECK(bench.take<wire::Next>().free_slots == 1);
}

TEST_CASE("heartbeats carry every lease with its step, and an abandoned job is killed and not reported") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  bench.feed(JobProgress{bench.started[0].job, 500});
  bench.after(5.1);
  const auto beat = bench.take<wire::Beat>();
  REQUIRE(beat.held.size() == 2);
  CHECK(beat.held[0].step == 500);
  bench.reply(wire::BeatReply{{wire::Ruling::abandon, wire::Ruling::adopt}, wire::Order::none});
  CHECK(bench.abandoned == std::vector<JobId>{bench.started[0].job});
  bench.feed(JobStopped{bench.started[0].job});
  const auto next = bench.take<wire::Next>();
  CHECK(next.returned.empty());
  CHECK(next.free_slots == 1);
}

TEST_CASE("a ruling is for the leases of its request, not for what came since") {
  Bench bench({.slots = 1});
  bench.welcome_and_take_next();
  bench.give({assignment(1)});
  bench.after(5.1);
  bench.take<wire::Beat>();
  bench.solve(0);  // while the beat is under way
  bench.reply(wire::BeatReply{{wire::Ruling::abandon}, wire::Order::none});
  CHECK(bench.abandoned.empty());
  CHECK(bench.take<wire::Next>().completed.size() == 1);
}

TEST_CASE("a restarted coordinator is told what is held, and nothing is started again") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  bench.solve(0);
  bench.take<wire::Next>();  // under way when the coordinator dies
  bench.feed(CoordinatorChanged{});
  bench.feed(RequestRefused{"say HELLO first"});
  const auto hello = bench.take<wire::Hello>();
  CHECK(hello.held.size() == 2);  // the running one, and the finished one that nobody acknowledged
  bench.reply(wire::Welcome{2, 5.0, 30.0, {wire::Ruling::adopt, wire::Ruling::adopt}});
  CHECK(bench.take<wire::Next>().completed.size() == 1);
  CHECK(bench.started.size() == 2);
  CHECK(bench.abandoned.empty());
}

TEST_CASE("a coordinator that hands the same job out again gets the work under its new lease") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1)});
  bench.after(0.6);
  bench.take<wire::Next>();
  wire::Assignment again = assignment(1);
  again.lease = {2, 9};
  bench.give({again});
  CHECK(bench.started.size() == 1);
  bench.solve(0);
  auto next = bench.take<wire::Next>();
  if (next.completed.empty()) bench.give({}), bench.after(0.6), next = bench.take<wire::Next>();
  REQUIRE(next.completed.size() == 1);
  CHECK(next.completed[0].lease == wire::LeaseId{2, 9});
}

TEST_CASE("what an earlier run left in the outbox is held in HELLO and reported first") {
  wire::Completion done;
  done.key = "old";
  done.lease = {1, 7};
  Bench bench({.slots = 1, .unacknowledged = {done}});
  const auto hello = bench.take<wire::Hello>();
  REQUIRE(hello.held.size() == 1);
  CHECK(hello.held[0].key == "old");
  bench.reply(wire::Welcome{4, 5.0, 30.0, {wire::Ruling::adopt}});
  CHECK(bench.take<wire::Next>().completed.at(0).key == "old");
  bench.give({}, {wire::Receipt::duplicate});
  CHECK(bench.acknowledged == std::vector<std::string>{"old"});
}

TEST_CASE("a failed job is reported with its class, its words and its lease") {
  Bench bench({.slots = 1});
  bench.welcome_and_take_next();
  bench.give({assignment(1)});
  bench.feed(JobFailed{bench.started[0].job, Fault::solver_crash, "it ended by SIGSEGV", "SIGSEGV"});
  const auto next = bench.take<wire::Next>();
  REQUIRE(next.failed.size() == 1);
  CHECK(next.failed[0].fault == Fault::solver_crash);
  CHECK(next.failed[0].lease == wire::LeaseId{1, 1});
  bench.give({}, {wire::Receipt::accepted});
  CHECK(bench.acknowledged.empty());  // the outbox knows nothing of faults
}

TEST_CASE("drain finishes what runs, gives back what waits, says BYE and ends well") {
  Bench bench({.slots = 1, .short_job_s = 1000.0});
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  REQUIRE(bench.started.size() == 1);
  bench.feed(DrainAsked{});
  const auto returned = bench.take<wire::Next>();
  CHECK(returned.returned == std::vector<wire::LeaseId>{{1, 2}});
  CHECK(returned.free_slots == 0);
  bench.give({});
  bench.solve(0);
  bench.after(1.0);
  CHECK(bench.take<wire::Next>().completed.size() == 1);
  bench.give({}, {wire::Receipt::accepted});
  bench.take<wire::Bye>();
  bench.reply(wire::ByeReply{});
  CHECK(bench.finished == exit_ok);
  CHECK(bench.stopped.empty());
}

TEST_CASE("TERM checkpoints what runs, gives it back as planned and ends as stopped") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  bench.feed(TerminateAsked{});
  CHECK(bench.stopped.size() == 2);
  bench.feed(JobStopped{bench.started[0].job});
  auto next = bench.take<wire::Next>();
  CHECK(next.returned.size() == 1);
  bench.give({});
  bench.feed(JobStopped{bench.started[1].job});
  next = bench.take<wire::Next>();
  CHECK(next.returned == std::vector<wire::LeaseId>{{1, 2}});
  CHECK(next.failed.empty());
  bench.give({});
  bench.take<wire::Bye>();
  bench.reply(wire::ByeReply{});
  CHECK(bench.finished == exit_stopped);
}

TEST_CASE("TERM ends in time even where no coordinator answers") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1)});
  bench.feed(TerminateAsked{});
  bench.feed(JobStopped{bench.started[0].job});
  bench.after(2.9);
  CHECK_FALSE(bench.finished);
  bench.after(0.2);
  CHECK(bench.finished == exit_stopped);
}

TEST_CASE("answers that take longer than beats are apart keep no result from being reported") {
  Bench bench({.slots = 1});
  bench.take<wire::Hello>();
  bench.reply(wire::Welcome{1, 0.2, 1.0, {}});
  bench.take<wire::Next>();
  bench.now += 0.25;
  bench.give({assignment(1)});
  bench.solve(0);
  int reported = 0;
  for (int n = 0; n < 8 && reported == 0; ++n) {
    REQUIRE(bench.posted.size() == 1);
    const bool next = std::holds_alternative<wire::Next>(bench.posted.front());
    reported += next ? static_cast<int>(std::get<wire::Next>(bench.posted.front()).completed.size()) : 0;
    bench.posted.clear();
    bench.now += 0.25;
    if (!next) bench.reply(wire::BeatReply{});
  }
  CHECK(reported == 1);
}

TEST_CASE("jobs that come while a worker leaves are given back before it says BYE") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.feed(DrainAsked{});
  bench.give({assignment(1), assignment(2)});  // the answer to what was asked before
  CHECK(bench.started.empty());
  CHECK(bench.take<wire::Next>().returned.size() == 2);
  bench.give({});
  bench.take<wire::Bye>();
  bench.reply(wire::ByeReply{});
  CHECK(bench.finished == exit_ok);
}

TEST_CASE("the end of the allocation is a planned stop in time") {
  Bench bench({.slots = 1, .end_margin_s = 30.0, .end_at = 200.0});
  CHECK(bench.take<wire::Hello>().remaining_s == 70.0);  // what is handed out must fit the time until it is stopped
  bench.reply(wire::Welcome{1, 1000.0, 3000.0, {}});
  CHECK(bench.take<wire::Next>().remaining_s == 70.0);
  bench.give({assignment(1)});
  bench.after(69.0);
  CHECK(bench.stopped.empty());
  bench.after(2.0);
  CHECK(bench.stopped.size() == 1);
}

TEST_CASE("STOP ends a worker that was started for one campaign, and only that") {
  const bool once = GENERATE(true, false);
  Bench bench({.slots = 1, .once = once});
  bench.welcome_and_take_next();
  wire::Jobs stop;
  stop.order = wire::Order::stop;
  bench.reply(stop);
  if (once) {
    bench.take<wire::Bye>();
    bench.reply(wire::ByeReply{});
    CHECK(bench.finished == exit_ok);
  } else {
    CHECK(bench.posted.empty());
    bench.after(61.0);
    CHECK(bench.posted.size() == 1);
  }
}

TEST_CASE("as many short jobs are asked for ahead as are solved while asking, and no long ones") {
  const double wall_s = GENERATE(0.002, 0.1, 100.0);
  Bench bench({.slots = 2});
  bench.take<wire::Hello>();
  bench.now += 0.05;  // the round trip: 0.01 s in the moving mean
  bench.reply(wire::Welcome{1, 5.0, 30.0, {}});
  bench.take<wire::Next>();
  bench.give({assignment(1), assignment(2)});
  bench.feed(JobSolved{bench.started[0].job, wall_s});
  const int per_slot = wall_s == 0.002 ? 4 : wall_s == 0.1 ? 1 : 0;
  CHECK(bench.take<wire::Next>().free_slots == 1 + 2 * per_slot);
}

TEST_CASE("five faults of the node in a row stop its claims for a while") {
  Bench bench({.slots = 1});
  bench.welcome_and_take_next();
  for (std::uint64_t n = 1; n <= 5; ++n) {
    bench.give({assignment(n)}, n == 1 ? std::vector<wire::Receipt>{} : std::vector{wire::Receipt::accepted});
    bench.feed(JobFailed{bench.started.back().job, Fault::node_lost, "disk full", "disk full"});
    if (n == 5) bench.after(0.6);
    const auto next = bench.take<wire::Next>();
    CHECK(next.free_slots == (n < 5 ? 1 : 0));
  }
  bench.give({}, {wire::Receipt::accepted});
  bench.after(1.0);
  CHECK(bench.posted.empty());
  bench.after(6.0);
  bench.take<wire::Beat>();
  bench.reply(wire::BeatReply{});
  CHECK(bench.take<wire::Next>().free_slots == 1);
}

TEST_CASE("receipts that do not fit what was sent settle nothing: everything is said again") {
  Bench bench({.slots = 1});
  bench.welcome_and_take_next();
  bench.give({assignment(1)});
  bench.solve(0);
  bench.after(0.6);
  auto next = bench.take<wire::Next>();
  if (next.completed.empty()) bench.give({}), bench.after(0.6), next = bench.take<wire::Next>();
  bench.give({}, {wire::Receipt::accepted, wire::Receipt::accepted});
  CHECK(bench.acknowledged.empty());
  bench.after(1.1);
  CHECK(bench.take<wire::Hello>().held.size() == 1);
}

TEST_CASE("a worker that is refused again and again ends and says so") {
  Bench bench;
  for (int i = 0; i < 5; ++i) {
    bench.take<wire::Hello>();
    bench.feed(RequestRefused{"wrong build"});
    if (i < 4) {
      CHECK_FALSE(bench.finished);
      bench.after(31.0);
    }
  }
  CHECK(bench.finished == exit_failed);
}

TEST_CASE("a worker whose slots are full sleeps until something happens, not a few milliseconds at a time") {
  Bench bench;
  bench.welcome_and_take_next();
  bench.give({assignment(1), assignment(2)});
  bench.now += 1.0;
  bench.feed(Tick{});
  REQUIRE(bench.posted.empty());
  CHECK(bench.session.next_tick(bench.now) - bench.now > 0.5);
}
