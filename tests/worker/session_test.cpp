#include "worker/session.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <set>

#include "common/base/random.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

wire::Assignment assignment(std::uint64_t n, std::uint64_t epoch = 1) {
  wire::Assignment a;
  a.lease = {epoch, n};
  a.key = "key" + std::to_string(n);
  a.job = n;
  return a;
}

// A session with its actions sorted by kind, as they come.
struct Bench {
  Session session;
  double now = 100.0;
  std::deque<wire::Request> posted;
  std::vector<StartJob> started;
  std::vector<JobId> stopped, abandoned;
  std::vector<std::string> acknowledged;
  std::optional<ExitCode> finished;

  explicit Bench(SessionOptions options = {.slots = 2}) : session(std::move(options)) { feed(Tick{}); }
  void feed(const Event& event) {
    for (Action& action : session.step(event, now)) {
      if (auto* post = std::get_if<Post>(&action)) posted.push_back(post->request);
      if (auto* start = std::get_if<StartJob>(&action)) started.push_back(*start);
      if (auto* stop = std::get_if<StopJob>(&action)) stopped.push_back(stop->job);
      if (auto* abandon = std::get_if<AbandonJob>(&action)) abandoned.push_back(abandon->job);
      if (auto* done = std::get_if<Acknowledged>(&action)) acknowledged.insert(acknowledged.end(), done->keys.begin(), done->keys.end());
      if (auto* end = std::get_if<Finish>(&action)) finished = end->status;
    }
  }
  void after(double seconds) {
    now += seconds;
    feed(Tick{});
  }
  template <class Kind>
  Kind take() {
    REQUIRE_FALSE(posted.empty());
    REQUIRE(std::holds_alternative<Kind>(posted.front()));
    Kind request = std::get<Kind>(posted.front());
    posted.pop_front();
    return request;
  }
  void reply(wire::Reply reply) { feed(ReplyCame{std::move(reply)}); }
  wire::Next welcome_and_take_next() {
    take<wire::Hello>();
    reply(wire::Welcome{1, 5.0, 30.0, {}});
    return take<wire::Next>();
  }
  void give(std::vector<wire::Assignment> jobs, std::vector<wire::Receipt> receipts = {}) {
    wire::Jobs answer;
    answer.receipts = std::move(receipts);
    answer.assignments = std::move(jobs);
    answer.wait_s = 0.5;
    reply(answer);
  }
  void solve(std::size_t n, double wall_s = 100.0) {
    feed(JobSolved{started[n].job, wall_s});
    wire::Completion done;
    done.key = started[n].assignment.key;
    done.lease = started[n].assignment.lease;
    feed(JobKept{started[n].job, done});
  }
};

}  // namespace

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
  bench.after(4.9);
  CHECK_FALSE(bench.finished);
  bench.after(0.2);
  CHECK(bench.finished == exit_stopped);
}

TEST_CASE("the end of the allocation is a planned stop in time") {
  Bench bench({.slots = 1, .end_margin_s = 30.0, .end_at = 200.0});
  CHECK(bench.take<wire::Hello>().remaining_s == 100.0);
  bench.reply(wire::Welcome{1, 1000.0, 3000.0, {}});
  CHECK(bench.take<wire::Next>().remaining_s == 100.0);
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

// A coordinator of a few lines, a network that loses, repeats and restarts, and solvers that do anything: whatever happens, a kept record
// is acknowledged in the end, no job runs twice at once and no slot is used twice.
TEST_CASE("in a thousand rough lives no finished record is lost and no job runs twice at once") {
  int kept_in_all = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    RandomStream random(seed, 1, 1);
    const int slots = random.integer(1, 4);
    Bench bench({.slots = slots, .short_job_s = random.uniform(0.1, 3.0)});
    std::map<JobId, std::string> running, keeping;
    std::set<std::string> kept;
    std::size_t seen_started = 0, seen_abandoned = 0;
    std::uint64_t lease = 0, epoch = 1;
    std::optional<wire::Request> at_coordinator;
    for (int step = 0; step < 300; ++step) {
      const bool calm = step > 200;  // faults stop
      if (!bench.posted.empty()) at_coordinator = bench.posted.front(), bench.posted.pop_front();
      switch (random.integer(0, calm ? 5 : 7)) {
        case 0:
        case 1:
          if (!at_coordinator) break;
          if (const auto* hello = std::get_if<wire::Hello>(&*at_coordinator)) {
            wire::Welcome welcome{epoch, 5.0, 30.0, {}};
            for (std::size_t i = 0; i < hello->held.size(); ++i)
              welcome.rulings.push_back(!calm && random.integer(0, 9) == 0 ? wire::Ruling::abandon : wire::Ruling::adopt);
            bench.reply(welcome);
          } else if (const auto* next = std::get_if<wire::Next>(&*at_coordinator)) {
            wire::Jobs jobs;
            jobs.receipts.assign(next->completed.size() + next->failed.size(), wire::Receipt::accepted);
            for (int i = 0; !calm && i < next->free_slots; ++i) jobs.assignments.push_back(assignment(++lease, epoch));
            bench.reply(jobs);
          } else if (const auto* beat = std::get_if<wire::Beat>(&*at_coordinator)) {
            bench.reply(wire::BeatReply{std::vector(beat->held.size(), wire::Ruling::adopt), wire::Order::none});
          }
          at_coordinator.reset();
          break;
        case 2:
          bench.after(random.uniform(0.0, 2.0));
          break;
        case 3:
          if (running.empty()) break;
          bench.feed(JobSolved{running.begin()->first, 0.2});
          keeping.insert(*running.begin());
          running.erase(running.begin());
          break;
        case 4:
          if (keeping.empty()) break;
          {
            wire::Completion done;
            done.key = keeping.begin()->second;
            kept.insert(done.key);
            bench.feed(JobKept{keeping.begin()->first, done});
            keeping.erase(keeping.begin());
          }
          break;
        case 5:
          for (; seen_abandoned < bench.abandoned.size(); ++seen_abandoned)
            if (running.erase(bench.abandoned[seen_abandoned]) > 0) bench.feed(JobStopped{bench.abandoned[seen_abandoned]});
          break;
        case 6:  // the coordinator dies and comes back; the request under way is lost or refused
          ++epoch;
          bench.feed(CoordinatorChanged{});
          if (!at_coordinator || std::holds_alternative<wire::Hello>(*at_coordinator)) break;
          bench.feed(RequestRefused{"say HELLO first"});
          at_coordinator.reset();
          break;
        default:
          if (running.empty()) break;
          bench.feed(JobFailed{running.begin()->first, Fault::solver_crash, "m", "s"});
          running.erase(running.begin());
      }
      for (; seen_started < bench.started.size(); ++seen_started) {
        const StartJob& start = bench.started[seen_started];
        for (const auto& [id, key] : running) REQUIRE(key != start.assignment.key);
        running.emplace(start.job, start.assignment.key);
      }
      REQUIRE(static_cast<int>(running.size()) <= slots);
    }
    const std::set<std::string> acknowledged(bench.acknowledged.begin(), bench.acknowledged.end());
    kept_in_all += static_cast<int>(kept.size());
    for (int i = 0; i < 40; ++i) {  // let the last words through
      bench.after(1.0);
      if (!bench.posted.empty()) at_coordinator = bench.posted.front(), bench.posted.pop_front();
      if (!at_coordinator) continue;
      if (const auto* hello = std::get_if<wire::Hello>(&*at_coordinator))
        bench.reply(wire::Welcome{epoch, 5.0, 30.0, std::vector(hello->held.size(), wire::Ruling::adopt)});
      else if (const auto* next = std::get_if<wire::Next>(&*at_coordinator))
        bench.give({}, std::vector(next->completed.size() + next->failed.size(), wire::Receipt::accepted));
      else if (const auto* beat = std::get_if<wire::Beat>(&*at_coordinator))
        bench.reply(wire::BeatReply{std::vector(beat->held.size(), wire::Ruling::adopt), wire::Order::none});
      at_coordinator.reset();
    }
    for (const std::string& key : kept) {
      CAPTURE(seed, key);
      REQUIRE(std::find(bench.acknowledged.begin(), bench.acknowledged.end(), key) != bench.acknowledged.end());
    }
  }
  CHECK(kept_in_all > 5000);
}
