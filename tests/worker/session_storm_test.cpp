// A coordinator of a few lines, a network that loses and restarts, and solvers that do anything: whatever happens, a kept record is
// acknowledged in the end, no job runs twice at once and no slot is used twice.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/base/random.hpp"
#include "tests/worker/session_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;
using namespace fracfarm::worker::bench;

namespace {

struct Storm {
  RandomStream random;
  int slots;
  Bench bench;
  std::map<JobId, std::string> running, keeping;
  std::set<std::string> kept;
  std::optional<wire::Request> at_coordinator;
  std::size_t seen_started = 0, seen_abandoned = 0;
  std::uint64_t lease = 0, epoch = 1;
  bool calm = false;  // faults have stopped, nothing more is handed out

  explicit Storm(std::uint64_t seed)
      : random(seed, 1, 1), slots(random.integer(1, 4)), bench({.slots = slots, .short_job_s = random.uniform(0.1, 3.0)}) {}

  void answer(const wire::Hello& hello) {
    wire::Welcome welcome{epoch, 5.0, 30.0, {}};
    for (std::size_t i = 0; i < hello.held.size(); ++i)
      welcome.rulings.push_back(!calm && random.integer(0, 9) == 0 ? wire::Ruling::abandon : wire::Ruling::adopt);
    bench.reply(welcome);
  }
  void answer(const wire::Next& next) {
    wire::Jobs jobs;
    jobs.receipts.assign(next.completed.size() + next.failed.size(), wire::Receipt::accepted);
    for (int i = 0; !calm && i < next.free_slots; ++i) jobs.assignments.push_back(assignment(++lease, epoch));
    bench.reply(jobs);
  }
  void answer(const wire::Beat& beat) {
    bench.reply(wire::BeatReply{std::vector(beat.held.size(), wire::Ruling::adopt), wire::Order::none});
  }
  void answer(const wire::Bye&) { bench.reply(wire::ByeReply{}); }
  void answer(const wire::Ask&) {}

  void receive() {
    if (at_coordinator || bench.posted.empty()) return;
    at_coordinator = bench.posted.front();
    bench.posted.pop_front();
  }
  void reply() {
    if (!at_coordinator) return;
    const wire::Request request = *std::exchange(at_coordinator, std::nullopt);
    std::visit([&](const auto& it) { answer(it); }, request);
  }
  void restart() {  // the request under way is asked again where it is HELLO, else refused
    ++epoch;
    bench.feed(CoordinatorChanged{});
    if (!at_coordinator || std::holds_alternative<wire::Hello>(*at_coordinator)) return;
    at_coordinator.reset();
    bench.feed(RequestRefused{"say HELLO first"});
  }
  void solve() {
    if (running.empty()) return;
    const auto job = *running.begin();
    running.erase(job.first);
    keeping.insert(job);
    bench.feed(JobSolved{job.first, 0.2});
  }
  void keep() {
    if (keeping.empty()) return;
    const auto job = *keeping.begin();
    keeping.erase(job.first);
    kept.insert(job.second);
    wire::Completion done;
    done.key = job.second;
    bench.feed(JobKept{job.first, done});
  }
  void crash() {
    if (running.empty()) return;
    const JobId job = running.begin()->first;
    running.erase(job);
    bench.feed(JobFailed{job, Fault::solver_crash, "m", "s"});
  }
  void end_abandoned() {
    for (; seen_abandoned < bench.abandoned.size(); ++seen_abandoned)
      if (running.erase(bench.abandoned[seen_abandoned]) > 0) bench.feed(JobStopped{bench.abandoned[seen_abandoned]});
  }
  void see_starts() {
    for (; seen_started < bench.started.size(); ++seen_started) {
      const StartJob& start = bench.started[seen_started];
      for (const auto& [id, key] : running) REQUIRE(key != start.assignment.key);
      running.emplace(start.job, start.assignment.key);
    }
    REQUIRE(static_cast<int>(running.size()) <= slots);
  }
  void blow() {
    receive();
    switch (random.integer(0, calm ? 5 : 7)) {
      case 0:
      case 1:
        reply();
        break;
      case 2:
        bench.after(random.uniform(0.0, 2.0));
        break;
      case 3:
        solve();
        break;
      case 4:
        keep();
        break;
      case 5:
        end_abandoned();
        break;
      case 6:
        restart();
        break;
      default:
        crash();
        break;
    }
    see_starts();
  }
};

}  // namespace

TEST_CASE("in a thousand rough lives no finished record is lost and no job runs twice at once") {
  std::size_t kept_in_all = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Storm storm(seed);
    for (int step = 0; step < 200; ++step) storm.blow();
    storm.calm = true;
    for (int step = 0; step < 100; ++step) storm.blow();
    for (int i = 0; i < 40; ++i) storm.bench.after(1.0), storm.receive(), storm.reply();  // the last words
    kept_in_all += storm.kept.size();
    const auto& acknowledged = storm.bench.acknowledged;
    for (const std::string& key : storm.kept) {
      CAPTURE(seed, key);
      REQUIRE(std::find(acknowledged.begin(), acknowledged.end(), key) != acknowledged.end());
    }
  }
  CHECK(kept_in_all > 5000);
}
