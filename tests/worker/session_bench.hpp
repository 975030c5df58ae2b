// A session with its actions sorted by kind, and the little that a test needs of a coordinator.
#pragma once

#include <catch2/catch.hpp>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "worker/session.hpp"

namespace fracfarm::worker::bench {

inline wire::Assignment assignment(std::uint64_t n, std::uint64_t epoch = 1) {
  wire::Assignment a;
  a.lease = {epoch, n};
  a.key = "key" + std::to_string(n);
  a.job = n;
  return a;
}

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

}  // namespace fracfarm::worker::bench
