// The talking half of a session: which request is due, and what a reply changes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "worker/session.hpp"

namespace fracfarm::worker {
namespace {

constexpr std::size_t batch_limit = 256;   // completions, failures and returns in one request
constexpr std::size_t spool_limit = 1000;  // completions not acknowledged, then no more claims
constexpr double prefetch_limit = 32.0;    // jobs per slot beyond what runs
constexpr double longest_wait_s = 60.0;
constexpr double longest_greet_delay_s = 30.0;
constexpr int refusal_limit = 5;

template <class T>
void forget_front(std::vector<T>& list, std::size_t number) {
  list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(std::min(number, list.size())));
}

template <class T>
std::vector<T> front(const std::vector<T>& list) {
  return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), batch_limit))};
}

}  // namespace

// --- asking ---

void Session::say_something() {
  const bool idle = jobs_.empty();
  if (phase_ == Phase::draining && idle && !anything_to_report()) phase_ = Phase::leaving;
  if (phase_ == Phase::terminating && idle) {
    if (give_up_at_ > 1e299) give_up_at_ = now_ + options_.farewell_s;
    if (!anything_to_report()) phase_ = Phase::leaving;
  }
  if (phase_ == Phase::leaving && give_up_at_ > 1e299) give_up_at_ = now_ + options_.farewell_s;
  if (now_ >= give_up_at_) return finish();
  if (asking_) return;
  if (auto request = next_request()) {
    asking_ = true;
    posted_at_ = now_;
    actions_.push_back(Post{std::move(*request)});
  }
}

std::optional<wire::Request> Session::next_request() {
  under_way_ = {};
  if (!welcomed_) return now_ >= greet_at_ ? std::optional(make_hello()) : std::nullopt;
  if (phase_ == Phase::leaving && !anything_to_report()) {  // a claim under way may have brought jobs that go back first
    under_way_.bye = true;
    return wire::Bye{};
  }
  const int want = wanted();
  const bool report = should_report(want);
  // Where answers take longer than beats are apart, there is always one due: what there is to say takes turns with them.
  if (now_ >= beat_at_ && !(report && beat_last_)) return make_beat();
  if (report) return make_next(want);
  return std::nullopt;
}

wire::Request Session::make_hello() {
  under_way_.hello = true;
  under_way_.held = held();
  return wire::Hello{options_.node,     options_.instance, options_.slots, options_.memory_bytes,
                     options_.build_id, remaining_s(),     under_way_.held};
}

// Until what runs is stopped: what is asked for must end before that.
double Session::remaining_s() const { return options_.end_at ? std::max(0.0, *options_.end_at - options_.end_margin_s - now_) : -1.0; }

wire::Request Session::make_beat() {
  under_way_.held = held();
  beat_at_ = now_ + beat_interval_s_;
  beat_last_ = true;
  return wire::Beat{under_way_.held};
}

wire::Request Session::make_next(int want) {
  wire::Next next{front(completed_), front(failed_), front(returned_), want, remaining_s()};
  beat_last_ = false;
  under_way_.completed = next.completed.size();
  under_way_.failed = next.failed.size();
  under_way_.returned = next.returned.size();
  under_way_.next = true;
  under_way_.wanted = static_cast<std::size_t>(want);
  return next;
}

// How many jobs to ask for: the free slots, and where jobs are short as many as are solved while asking. Not more: what one worker holds
// ahead, another may be waiting for.
int Session::wanted() const {
  if (phase_ != Phase::working || now_ < ask_at_ || now_ < claims_from_ || completed_.size() >= spool_limit) return 0;
  const bool short_jobs = mean_job_s_ > 0.0 && mean_job_s_ < options_.short_job_s;
  const double solved_meanwhile = short_jobs ? std::clamp(std::ceil(round_trip_s_ / mean_job_s_), 1.0, prefetch_limit) : 0.0;
  const int ahead = options_.slots * static_cast<int>(solved_meanwhile);
  const int queued = count(State::queued);
  const int free = options_.slots - count(State::running) - count(State::abandoned) - queued;
  if (free <= 0 && 2 * queued >= ahead) return 0;  // enough for now: ask in batches
  return std::max(0, free + ahead);
}

bool Session::should_report(int want) const {
  if (want > 0) return true;
  if (!anything_to_report()) return false;
  const bool many = completed_.size() + failed_.size() + returned_.size() >= batch_limit / 8;
  return many || phase_ != Phase::working || now_ >= report_since_ + options_.report_delay_s;
}

// --- hearing ---

void Session::on(const ReplyCame& event) {
  if (!asking_) return;
  asking_ = false;
  round_trip_s_ = 0.8 * round_trip_s_ + 0.2 * (now_ - posted_at_);
  std::visit([&](const auto& reply) { hear(reply); }, event.reply);
}

void Session::on(const RequestRefused& event) {
  if (!asking_) return;
  asking_ = false;
  hear(wire::Refusal{event.reason});
}

void Session::on(const CoordinatorChanged&) {
  if (welcomed_) greet_again(0.0);
}

void Session::greet_again(double after_s) {
  welcomed_ = false;
  greet_at_ = now_ + after_s;
}

void Session::hear(const wire::Welcome& welcome) {
  welcomed_ = true;
  refusals_ = 0;
  greet_delay_s_ = 1.0;
  beat_interval_s_ = std::clamp(welcome.beat_interval_s, 0.05, 300.0);
  beat_at_ = now_ + beat_interval_s_;
  ask_at_ = now_;
  say(Say::Level::info, fmt::format("welcomed in epoch {}", welcome.epoch));
  follow(welcome.rulings);
}

void Session::hear(const wire::Jobs& jobs) {
  if (!under_way_.next) return greet_again(greet_delay_s_);
  settle(jobs.receipts);
  for (const wire::Assignment& assignment : jobs.assignments) take(assignment);
  if (jobs.assignments.size() < under_way_.wanted) ask_at_ = now_ + std::clamp(jobs.wait_s, 0.05, longest_wait_s);
  hear_order(jobs.order, jobs.wait_s);
}

void Session::hear(const wire::BeatReply& reply) {
  follow(reply.rulings);
  hear_order(reply.order, 0.0);
}

void Session::hear(const wire::ByeReply&) {
  if (under_way_.bye) finish();
}

void Session::hear(const wire::Answer&) { greet_again(greet_delay_s_); }  // nothing that a worker asks is answered so

// Most often a coordinator that was started again and does not know this worker yet.
void Session::hear(const wire::Refusal& refusal) {
  const bool greeting = under_way_.hello;
  refusals_ += greeting ? 1 : 0;
  say(Say::Level::warning, refusal.reason);
  if (greeting && refusals_ >= refusal_limit && jobs_.empty()) {
    say(Say::Level::error, "the coordinator refuses this worker: ending");
    status_ = exit_failed;
    return finish();
  }
  greet_again(greeting ? greet_delay_s_ : 0.0);
  if (greeting) greet_delay_s_ = std::min(2.0 * greet_delay_s_, longest_greet_delay_s);
}

void Session::hear_order(wire::Order order, double wait_s) {
  if (order == wire::Order::drain) on(DrainAsked{});
  if (order != wire::Order::stop) return;
  if (options_.once && jobs_.empty()) return on(DrainAsked{});
  ask_at_ = now_ + std::clamp(wait_s, 0.5, longest_wait_s);
}

// Rulings are for the leases of the request that was under way; what has ended since is past ruling.
void Session::follow(const std::vector<wire::Ruling>& rulings) {
  for (std::size_t i = 0; i < std::min(rulings.size(), under_way_.held.size()); ++i) {
    if (rulings[i] != wire::Ruling::abandon) continue;
    const auto job = std::find_if(jobs_.begin(), jobs_.end(), [&](const Job& j) { return j.assignment.lease == under_way_.held[i].lease; });
    if (job == jobs_.end() || job->state == State::keeping) continue;
    say(Say::Level::info, fmt::format("abandoning job {}", job->assignment.job));
    if (job->state == State::running) {
      actions_.push_back(AbandonJob{job->id});
      job->state = State::abandoned;
    } else if (job->state == State::queued) {
      jobs_.erase(job);
    }
  }
}

// A reply with another number of receipts is no answer to what was asked: everything is said again after a new HELLO.
void Session::settle(const std::vector<wire::Receipt>& receipts) {
  if (receipts.size() != under_way_.completed + under_way_.failed) {
    say(Say::Level::error, fmt::format("{} receipts for {} results", receipts.size(), under_way_.completed + under_way_.failed));
    return greet_again(greet_delay_s_);
  }
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < receipts.size(); ++i) {
    const std::string& key = i < under_way_.completed ? completed_[i].key : failed_[i - under_way_.completed].key;
    if (i < under_way_.completed) keys.push_back(key);
    if (receipts[i] == wire::Receipt::refused) say(Say::Level::error, fmt::format("the coordinator refused the result of {}", key));
  }
  forget_front(completed_, under_way_.completed);
  forget_front(failed_, under_way_.failed);
  forget_front(returned_, under_way_.returned);
  if (anything_to_report()) report_since_ = now_;
  if (!keys.empty()) actions_.push_back(Acknowledged{std::move(keys)});
}

}  // namespace fracfarm::worker
