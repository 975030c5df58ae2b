#include "worker/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr int claims_after_faults = 5;  // NODE_LOST in a row before claims pause
constexpr double longest_claim_pause_s = 300.0;
constexpr double mean_weight = 0.2;  // of the newest job in the moving mean

}  // namespace

Session::Session(SessionOptions options) : options_(std::move(options)), completed_(options_.unacknowledged) {}

Actions Session::step(const Event& event, double now) {
  now_ = now;
  if (phase_ == Phase::ended) return {};
  const bool reported_before = anything_to_report();
  std::visit([&](const auto& e) { on(e); }, event);
  if (!reported_before && anything_to_report()) report_since_ = now;
  if (options_.end_at && now > *options_.end_at - options_.end_margin_s && phase_ <= Phase::draining) {
    say(Say::Level::info, "the allocation ends: checkpointing");
    on(TerminateAsked{});
  }
  start_queued();
  say_something();
  return std::exchange(actions_, {});
}

double Session::next_tick(double now) const {
  double at = std::min(now + 1.0, give_up_at_);
  if (!asking_ && !welcomed_) at = std::min(at, greet_at_);
  if (!asking_ && welcomed_) {
    at = std::min(at, beat_at_);
    // A time to ask that is past was not used because no slot is free: its end will call.
    if (const double ask = std::max(ask_at_, claims_from_); ask > now) at = std::min(at, ask);
    if (anything_to_report()) at = std::min(at, report_since_ + options_.report_delay_s);
  }
  return std::max(now + 0.005, at);
}

// --- jobs ---

void Session::on(const JobProgress& event) {
  if (Job* job = find(event.job)) job->step = event.step;
}

void Session::on(const JobSolved& event) {
  Job* job = find(event.job);
  if (!job || job->state == State::abandoned) return drop(event.job);
  job->state = State::keeping;
  mean_job_s_ = mean_job_s_ == 0.0 ? event.wall_s : (1.0 - mean_weight) * mean_job_s_ + mean_weight * event.wall_s;
}

// A kept record is reported even where its lease was abandoned meanwhile: the first valid result wins.
void Session::on(const JobKept& event) {
  completed_.push_back(event.completion);
  if (const Job* job = find(event.job)) completed_.back().lease = job->assignment.lease;
  drop(event.job);
  node_faults_ = 0;
}

void Session::on(const JobFailed& event) {
  const Job* job = find(event.job);
  if (job && job->state != State::abandoned)
    failed_.push_back({job->assignment.lease, job->assignment.key, event.fault, event.message, event.signature});
  drop(event.job);
  node_faults_ = event.fault == Fault::node_lost ? node_faults_ + 1 : 0;
  if (node_faults_ < claims_after_faults) return;
  const double pause = std::min(longest_claim_pause_s, 5.0 * std::exp2(node_faults_ - claims_after_faults));
  claims_from_ = now_ + pause;
  say(Say::Level::error,
      fmt::format("{} faults of this node in a row, the last: {}; no claims for {:.0f} s", node_faults_, event.message, pause));
}

void Session::on(const JobStopped& event) {
  const Job* job = find(event.job);
  if (job && job->state != State::abandoned) returned_.push_back(job->assignment.lease);
  drop(event.job);
}

void Session::start_queued() {
  if (phase_ != Phase::working) return return_queued();
  int busy = count(State::running) + count(State::abandoned);
  for (Job& job : jobs_) {
    if (busy >= options_.slots) break;
    if (job.state != State::queued) continue;
    job.state = State::running;
    job.started_at = now_;
    actions_.push_back(StartJob{job.id, job.assignment});
    ++busy;
  }
}

void Session::return_queued() {
  for (const Job& job : jobs_)
    if (job.state == State::queued) returned_.push_back(job.assignment.lease);
  std::erase_if(jobs_, [](const Job& job) { return job.state == State::queued; });
}

// The same key under another lease is the same work: a coordinator that lost track of it hands it out again.
void Session::take(const wire::Assignment& assignment) {
  for (wire::Completion& done : completed_)
    if (done.key == assignment.key) {
      done.lease = assignment.lease;
      return;
    }
  for (Job& job : jobs_)
    if (job.assignment.key == assignment.key && job.state != State::abandoned) {
      job.assignment.lease = assignment.lease;
      return;
    }
  jobs_.push_back({++last_id_, assignment});
}

Session::Job* Session::find(JobId id) {
  const auto found = std::find_if(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.id == id; });
  return found == jobs_.end() ? nullptr : &*found;
}

void Session::drop(JobId id) {
  std::erase_if(jobs_, [&](const Job& job) { return job.id == id; });
}

int Session::count(State state) const {
  return static_cast<int>(std::count_if(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.state == state; }));
}

// Everything that the coordinator must not hand to another: jobs at hand, and finished ones that it does not know of yet.
std::vector<wire::HeldLease> Session::held() const {
  std::vector<wire::HeldLease> all;
  for (const Job& job : jobs_)
    if (job.state != State::abandoned) all.push_back({job.assignment.lease, job.assignment.key, job.step});
  for (const wire::Completion& done : completed_) all.push_back({done.lease, done.key, done.steps});
  return all;
}

// --- ending ---

void Session::on(const DrainAsked&) {
  if (phase_ == Phase::working) begin_leaving(Phase::draining, exit_ok);
}

void Session::on(const TerminateAsked&) {
  if (phase_ > Phase::draining) return;
  begin_leaving(Phase::terminating, exit_stopped);
  for (const Job& job : jobs_)
    if (job.state == State::running) actions_.push_back(StopJob{job.id});
}

void Session::begin_leaving(Phase phase, ExitCode status) {
  phase_ = phase;
  status_ = status;
  return_queued();
}

void Session::finish() {
  phase_ = Phase::ended;
  actions_.push_back(Finish{status_});
}

void Session::say(Say::Level level, std::string text) { actions_.push_back(Say{level, std::move(text)}); }

}  // namespace fracfarm::worker
