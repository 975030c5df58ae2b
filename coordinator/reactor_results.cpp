// Results, faults and claims: what NEXT brings and what it gets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/reactor.hpp"
#include "coordinator/retry_policy.hpp"

namespace fracfarm {
namespace {

constexpr int claim_page = 64;   // READY jobs looked at at once
constexpr int claim_pages = 16;  // and how often, where they do not fit the claimant
constexpr double relearn_s = 5.0;

bool is_file_name(const std::string& name) {
  return !name.empty() && name.size() <= 200 && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
  });
}

// What is wrong with a result, or empty. A worker is trusted with physics, never with the shape of a message.
std::string wrong_with(const wire::Completion& it) {
  constexpr std::uint64_t largest = std::uint64_t{1} << 60;
  if (it.verdict == Verdict::diverged) return "a diverged run is a fault, not a result";
  if ((it.verdict == Verdict::failed) != it.time_to_failure.has_value())
    return "a time to failure belongs to the verdict 'failed' and to no other";
  if (it.time_to_failure && !(std::isfinite(*it.time_to_failure) && *it.time_to_failure >= 0.0)) return "the time to failure is not a time";
  if (!std::isfinite(it.peak_stress) || !std::isfinite(it.cpu_s) || !std::isfinite(it.wall_s) || it.steps < 0)
    return "a number is not finite";
  if (it.verdict == Verdict::rejected && it.shard.empty()) return {};
  if (!is_file_name(it.shard)) return "the shard is not a plain file name";
  if (it.offset > largest || it.length == 0 || it.length > largest) return "the place of the record is not one";
  if (bytes_of_hex(it.sha256).size() != 32) return "the digest is not a SHA-256";
  return {};
}

Outcome outcome_of(const wire::Completion& it, double wall_s) {
  return {it.verdict, it.time_to_failure, it.failure_rule, it.peak_stress, it.steps, it.cpu_s, it.wall_s,
          wall_s,     it.shard,           it.offset,       it.length,      it.sha256};
}

// The same physics, bit for bit. Records also carry times and the attempt, so equal physics may have unequal digests.
bool same_physics(const Outcome& a, const wire::Completion& b) {
  return a.verdict == b.verdict && a.time_to_failure == b.time_to_failure && a.peak_stress == b.peak_stress && a.steps == b.steps;
}

// A wall clock ends a run where it happens to be: no reproducible end.
bool ended_by_clock(Verdict verdict, const std::string& rule) { return verdict == Verdict::censored && rule == "wall_clock"; }

}  // namespace

wire::Receipt Reactor::on_duplicate(const Job& job, const wire::Completion& completion, Instant now) {
  const Outcome& first = *job.outcome;
  const bool same_bytes = first.sha256 == completion.sha256;
  if (same_bytes && job.lease == completion.lease && first.shard == completion.shard && first.offset == completion.offset)
    return wire::Receipt::accepted;
  const bool comparable = job.step_scale == 1.0 && !ended_by_clock(first.verdict, first.failure_rule) &&
                          !ended_by_clock(completion.verdict, completion.failure_rule);
  if (!same_bytes && comparable && !same_physics(first, completion)) {
    const auto said = [](const auto& it) {
      return fmt::format("{} {} at {} s, peak {} Pa, {} steps, digest {:.12}", name_of(it.verdict), it.failure_rule,
                         it.time_to_failure.value_or(NAN), it.peak_stress, it.steps, it.sha256);
    };
    ledger_.raise_nondeterminism(job.id, fmt::format("two results of one key and build: {} | {}", said(first), said(completion)),
                                 now.wall_s);
    note(fmt::format("NONDETERMINISM: job {} gave two different results", job.id));
  }
  return wire::Receipt::duplicate;
}

wire::Receipt Reactor::on_completion(const std::string& peer, Session& session, const wire::Completion& completion, Instant now) {
  const std::optional<Job> job = job_by_key(ledger_.reading(), completion.key);
  if (!job || completion.lease.epoch > epoch_ || completion.lease.epoch == 0) return wire::Receipt::refused;
  const bool current = holds(peer, completion.lease, *job);
  if (const std::string wrong = wrong_with(completion); !wrong.empty()) {
    const Fault fault = completion.verdict == Verdict::diverged ? Fault::solver_numeric : Fault::output_bad;
    if (current) end_try(*job, {fault, "completion", fmt::format("the result was refused: {}", wrong)}, now);
    return wire::Receipt::refused;
  }
  if (job->state == State::done) return on_duplicate(*job, completion, now);
  if (job->state == State::cancelled) return wire::Receipt::stale;
  ledger_.complete(*job, outcome_of(completion, now.wall_s), completion.lease, session.worker);
  held_.erase({job->lease.epoch, job->lease.counter});
  session.fast_faults = 0;
  rate_.count(now.monotonic_s);
  return wire::Receipt::accepted;
}

wire::Receipt Reactor::on_failed(const std::string& peer, Session& session, const wire::Failed& failed, Instant now) {
  const std::optional<Job> job = job_by_key(ledger_.reading(), failed.key);
  if (!job) return wire::Receipt::refused;
  if (!holds(peer, failed.lease, *job)) return wire::Receipt::stale;
  count_fast(session, failed.lease, failed.fault, now);
  end_try(*job, {failed.fault, failed.signature, failed.message}, now);
  return wire::Receipt::accepted;
}

void Reactor::count_fast(Session& session, const wire::LeaseId& lease, Fault fault, Instant now) {
  const bool may_be_the_node =
      fault == Fault::node_lost || fault == Fault::output_bad || fault == Fault::solver_crash || fault == Fault::out_of_memory;
  const auto held = held_.find({lease.epoch, lease.counter});
  if (!may_be_the_node || held == held_.end()) return;
  const bool fast = now.monotonic_s - held->second.began_s < fast_fault_s;
  session.fast_faults = fast ? session.fast_faults + 1 : 0;
  if (session.fast_faults == most_fast_faults)
    note(fmt::format("{}: {} fast faults in a row; it gets no more work until it is started again", session.node, most_fast_faults));
}

void Reactor::on_returned(const std::string& peer, const wire::LeaseId& lease, Instant now) {
  const std::optional<Job> job = job_by_lease(ledger_.reading(), lease);
  if (job && holds(peer, lease, *job)) end_try(*job, {Fault::planned_stop, "", "given back"}, now);
}

// The current try of a LEASED job is over without a result: history, budgets, next state.
void Reactor::end_try(const Job& job, const Attempt& attempt, Instant now) {
  held_.erase({job.lease.epoch, job.lease.counter});
  ledger_.record_attempt(job, attempt, now.wall_s);
  std::vector<AttemptRow> history = attempts_of(ledger_.reading(), job.id);
  std::erase_if(history, [&](const AttemptRow& row) { return row.id <= job.forgiven; });
  const auto campaign = book_.open(ledger_.reading(), job.campaign);
  const RetryDecision next = decide_retry(job, history, campaign ? (*campaign)->attempts : 1);
  if (next.state == State::ready) ledger_.make_ready(job.id);
  if (next.state == State::quarantined) ledger_.quarantine(job.id);
  if (next.state == State::retry_wait) {
    ledger_.make_wait(job.id, next.wait_s, next.step_scale);
    due_.emplace(now.monotonic_s + next.wait_s, job.id);
  }
  if (attempt.fault != Fault::planned_stop)
    note(fmt::format("job {}: {} ({}); {}", job.id, fault_row(attempt.fault).name, attempt.message.substr(0, 200), next.why));
}

// Work for free slots; where there is none, what to do instead.
void Reactor::hand_out(Session& session, int free_slots, wire::Jobs& reply, Instant now) {
  const std::optional<WorkerRow> row = worker_row(ledger_.reading(), session.worker);
  if (row && row->draining) {
    reply.order = wire::Order::drain;
    return;
  }
  const bool may_work = !session.stopped() && !wrong_build(session.build_id) && !wrong_build(settings_.build_id);
  if (may_work)
    for (const Job& job : choose(session, std::min(free_slots, most_jobs_a_slot * std::min(session.slots, most_jobs_a_claim)), now))
      reply.assignments.push_back(assign(job, session, now));
  if (!reply.assignments.empty()) return;
  reply.order = settled() ? wire::Order::stop : wire::Order::wait;
  reply.wait_s = std::clamp(static_cast<double>(roster_.size()) / 200.0, 0.5, 10.0);
}

// Nothing where this program cannot read the job's campaign.
std::optional<Candidate> Reactor::candidate_of(const Job& job) {
  const auto campaign = book_.open(ledger_.reading(), job.campaign);
  if (!campaign) return std::nullopt;
  Candidate candidate{job.id, job.job_class, (*campaign)->wall_budget_s, {}};
  if (job.attempts == 0) return candidate;
  for (const AttemptRow& row : attempts_of(ledger_.reading(), job.id))
    if (row.id > job.forgiven && row.fault != fault_row(Fault::planned_stop).name) candidate.failed_on.insert(row.node);
  return candidate;
}

// Looks at READY jobs a page at a time, so that jobs which do not fit this claimant hide none that do; the number of pages is bounded.
std::vector<Job> Reactor::choose(const Session& session, int most, Instant now) {
  if (now.monotonic_s - learned_at_s_ > relearn_s) {
    learned_ = learned_times(ledger_.reading());
    learned_at_s_ = now.monotonic_s;
  }
  const std::set<std::string> nodes = live_nodes(now);
  std::vector<Job> chosen;
  ClaimCursor cursor;
  for (int page = 0; page < claim_pages && static_cast<int>(chosen.size()) < most; ++page) {
    const int left = most - static_cast<int>(chosen.size());
    std::vector<Job> jobs = ready_jobs(ledger_.reading(), cursor, page == 0 ? std::min(left, most_jobs_a_claim) : claim_page);
    if (jobs.empty()) break;
    cursor = {jobs.back().priority, jobs.back().id};
    std::vector<Candidate> candidates;
    std::erase_if(jobs, [&](const Job& job) {
      const std::optional<Candidate> candidate = candidate_of(job);
      if (candidate) candidates.push_back(*candidate);
      return !candidate;
    });
    for (const std::size_t at : claim(candidates, {session.node, left, session.remaining_s}, learned_, nodes))
      chosen.push_back(std::move(jobs[at]));
  }
  return chosen;
}

wire::Assignment Reactor::assign(const Job& job, const Session& session, Instant now) {
  const wire::LeaseId lease{epoch_, ++counter_};
  ledger_.lease(job.id, lease, session.worker, now.wall_s);
  held_[{lease.epoch, lease.counter}] = {job.id, now.monotonic_s + settings_.lease_timeout_s, now.monotonic_s, 0};
  const std::shared_ptr<const Campaign> campaign = book_.open(ledger_.reading(), job.campaign).value();  // candidate_of opened it
  return {lease,
          job.key,
          static_cast<std::uint64_t>(job.id),
          job.attempts + 1,
          scene_text(*campaign, job.position),
          campaign->wall_budget_s,
          job.step_scale,
          campaign->store};
}

}  // namespace fracfarm
