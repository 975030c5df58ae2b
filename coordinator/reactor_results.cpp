// Results and faults: what NEXT brings. What it gets is in reactor_claims.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/reactor.hpp"
#include "coordinator/retry_policy.hpp"

namespace fracfarm {
namespace {

constexpr std::size_t most_outrun = 1000;

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

// By this lease to compute it again, or at any time to do it: a lease that ended meanwhile does not spoil a result, a stranger's word does.
bool was_given(Database& ledger, const std::string& peer, const Job& job, const wire::LeaseId& lease) {
  const auto is_peer = [&](std::int64_t worker) {
    const std::optional<WorkerRow> row = worker_row(ledger, worker);
    return row && row->peer == peer;
  };
  if (job.worker != 0 && is_peer(job.worker)) return true;
  for (const AttemptRow& row : attempts_of(ledger, job.id))
    if (row.peer == peer) return true;
  const std::vector<RecheckRow> again = rechecks_of(ledger, job.id);
  return std::any_of(again.begin(), again.end(), [&](const RecheckRow& row) { return row.lease == lease && is_peer(row.worker); });
}

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

// The ledger keeps no try that ended because another came first.
bool Reactor::was_outrun(const std::string& peer, const Job& job, const wire::LeaseId& lease) const {
  return std::any_of(outrun_.begin(), outrun_.end(), [&](const Outrun& it) {
    if (it.job != job.id || !(it.lease == lease)) return false;
    const std::optional<WorkerRow> row = worker_row(ledger_.reading(), it.worker);
    return row && row->peer == peer;
  });
}

wire::Receipt Reactor::on_completion(const std::string& peer, Session& session, const wire::Completion& completion, Instant now) {
  const std::optional<Job> job = job_by_key(ledger_.reading(), completion.key);
  if (!job || completion.lease.epoch > epoch_ || completion.lease.epoch == 0) return wire::Receipt::refused;
  if (job->worker != session.worker && !was_given(ledger_.reading(), peer, *job, completion.lease) &&
      !was_outrun(peer, *job, completion.lease)) {
    note(fmt::format("{} says that it did job {}, which it was never given: refused", peer, job->id));
    return wire::Receipt::refused;
  }
  const std::optional<RecheckRow> recheck = job->state == State::done ? recheck_of(completion.lease) : std::nullopt;
  const bool current = holds(peer, completion.lease, *job);
  if (const std::string wrong = wrong_with(completion); !wrong.empty()) {
    const Fault fault = completion.verdict == Verdict::diverged ? Fault::solver_numeric : Fault::output_bad;
    if (current) end_try(*job, {fault, "completion", fmt::format("the result was refused: {}", wrong)}, now);
    if (recheck) fail_recheck(*recheck, {fault, "completion", fmt::format("the result was refused: {}", wrong)}, now);
    return wire::Receipt::refused;
  }
  if (recheck) return end_recheck(*recheck, *job, completion, session, now);
  if (job->state == State::done) return on_duplicate(*job, completion, now);
  if (job->state == State::cancelled) return wire::Receipt::stale;
  if (job->state == State::leased && !(job->lease == completion.lease)) {
    outrun_.push_back({job->id, job->lease, job->worker});
    if (outrun_.size() > most_outrun) outrun_.pop_front();
  }
  ledger_.complete(*job, outcome_of(completion, now.wall_s), completion.lease, session.worker);
  held_.erase({job->lease.epoch, job->lease.counter});
  session.fast_faults = 0;
  rate_.count(now.monotonic_s);
  settle_blame(*job, session.node);
  count_attempt(job->job_class, false, now);
  sample_for_audit(*job, session.node, now);
  return wire::Receipt::accepted;
}

// Nodes that failed what `node` did are blamed; what is held against `node` is forgotten after enough results.
void Reactor::settle_blame(const Job& job, const std::string& node) {
  if (const auto held = nodes_.find(node); held != nodes_.end() && held->second.suspect.empty()) {
    ledger_.count_done(node);
    if (++held->second.done_since >= results_to_forget) {
      ledger_.trust(node);
      nodes_.erase(held);
    }
  }
  if (job.attempts < 2) return;
  for (const std::string& blamed : blamed_nodes(attempts_of(ledger_.reading(), job.id), node)) {
    ledger_.blame(blamed);
    NodeRow& row = nodes_[blamed];
    row.node = blamed;
    row.done_since = 0;
    if (++row.blamed >= blames_of_a_suspect && row.suspect.empty())
      suspect(blamed, fmt::format("{} of its failures were of jobs that other nodes then did, the last job {}", row.blamed, job.id));
  }
}

void Reactor::suspect(const std::string& node, const std::string& why) {
  ledger_.suspect(node, why);
  NodeRow& row = nodes_[node];
  row.node = node;
  row.suspect = why;
  notice({"suspect", fmt::format("{} gets a canary before work: {}", node, why), 0, node});
}

void Reactor::count_attempt(const JobClass& job_class, bool job_reason, Instant now) {
  Fuse& fuse = fuses_[job_class];
  if (!fuse.blows(job_reason) || paused_.contains(job_class)) return;
  const std::string why =
      fmt::format("more than {} of its last {} attempts failed for reasons of the jobs", fuse_most_failed, fuse.last_seen());
  ledger_.pause_class(job_class, why, now.wall_s);
  ledger_.raise_alarm("FUSE", 0, fmt::format("{} is paused: {}", text_of(job_class), why), now.wall_s);
  paused_[job_class] = why;
  notice({"paused", fmt::format("{} is paused: {}; fracfarm failures --explain looks for the cause, fracfarm resume goes on",
                                text_of(job_class), why)});
}

wire::Receipt Reactor::on_failed(const std::string& peer, Session& session, const wire::Failed& failed, Instant now) {
  const std::optional<Job> job = job_by_key(ledger_.reading(), failed.key);
  if (!job) return wire::Receipt::refused;
  if (job->state == State::done)
    if (const std::optional<RecheckRow> recheck = recheck_of(failed.lease); recheck && recheck->worker == session.worker)
      return fail_recheck(*recheck, {failed.fault, failed.signature, failed.message}, now), wire::Receipt::accepted;
  if (!holds(peer, failed.lease, *job)) return wire::Receipt::stale;
  count_fast(session, failed.lease, failed.fault, now);
  end_try(*job, {failed.fault, failed.signature, failed.message}, now);
  return wire::Receipt::accepted;
}

void Reactor::count_fast(Session& session, const wire::LeaseId& lease, Fault fault, Instant now) {
  const auto held = held_.find({lease.epoch, lease.counter});
  if (!fault_row(fault).node_suspected || held == held_.end()) return;
  const bool fast = now.monotonic_s - held->second.began_s < fast_fault_s;
  if (std::exchange(session.fault_counted, true)) return;
  session.fast_faults = fast ? session.fast_faults + 1 : 0;
  if (session.fast_faults == most_fast_faults)
    notice({"stopped",
            fmt::format("{}: {} fast faults in a row; it gets no more work until it does a job whose result is known, or is started again",
                        session.node, most_fast_faults),
            0, session.node});
}

void Reactor::on_returned(const std::string& peer, const wire::LeaseId& lease, Instant now) {
  const std::optional<Job> job = job_by_lease(ledger_.reading(), lease);
  if (job && holds(peer, lease, *job)) return end_try(*job, {Fault::planned_stop, "", "given back"}, now);
  if (const std::optional<RecheckRow> recheck = recheck_of(lease)) {
    const std::optional<WorkerRow> holder = worker_row(ledger_.reading(), recheck->worker);
    if (holder && holder->peer == peer) fail_recheck(*recheck, {Fault::planned_stop, "", "given back"}, now);
  }
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
    std::uint64_t floor = job.memory_floor;
    if (next.more_memory)
      if (const std::optional<WorkerRow> worker = worker_row(ledger_.reading(), job.worker))
        floor = std::max(floor, worker->memory_bytes / static_cast<std::uint64_t>(std::max(1, worker->slots)));
    ledger_.make_wait(job.id, next.wait_s, next.step_scale, floor);
    due_.emplace(now.monotonic_s + next.wait_s, job.id);
  }
  if (attempt.fault == Fault::planned_stop) return;
  const std::string said =
      fmt::format("job {}: {} ({}); {}", job.id, fault_row(attempt.fault).name, attempt.message.substr(0, 200), next.why);
  if (next.state == State::quarantined)
    notice({"quarantined", said, job.id});
  else
    note(said);
  count_attempt(job.job_class, is_job_reason(attempt.fault), now);
}

}  // namespace fracfarm
