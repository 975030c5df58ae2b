// DONE jobs that are computed again: canaries for nodes that something is held against, audits of a sample on another node, repairs of
// damaged records. The job stays DONE throughout; only the comparison, or for a repair the place of its bytes, is new.
#include <fmt/format.h>

#include <algorithm>

#include "common/base/hash.hpp"
#include "coordinator/reactor.hpp"

namespace fracfarm {
namespace {

constexpr int most_tries = 3;  // of an audit or a repair
constexpr std::string_view canary = "CANARY", audit = "AUDIT", repair = "REPAIR";

bool same_physics(const Outcome& a, const wire::Completion& b) {
  return a.verdict == b.verdict && a.time_to_failure == b.time_to_failure && a.peak_stress == b.peak_stress && a.steps == b.steps;
}

std::string difference(const Outcome& first, const wire::Completion& second) {
  const auto said = [](const auto& it) {
    return fmt::format("{} {} at {} s, peak {} Pa, {} steps", name_of(it.verdict), it.failure_rule, it.time_to_failure.value_or(NAN),
                       it.peak_stress, it.steps);
  };
  return fmt::format("{} | {}", said(first), said(second));
}

}  // namespace

std::optional<RecheckRow> Reactor::recheck_of(const wire::LeaseId& lease) {
  const auto held = held_.find({lease.epoch, lease.counter});
  if (held == held_.end() || held->second.recheck == 0) return std::nullopt;
  return recheck_row(ledger_.reading(), held->second.recheck);
}

bool Reactor::must_prove_itself(const Session& session) const {
  const auto known = nodes_.find(session.node);
  return session.stopped() || (known != nodes_.end() && !known->second.suspect.empty());
}

// One canary a node at a time. Without a known result nobody can prove anything: a suspect then works on, a stopped worker does not.
void Reactor::give_canary(Session& session, wire::Jobs& reply, Instant now) {
  Canary& state = canaries_[session.node];
  if (state.under_way || now.monotonic_s < state.next_s) return;
  const std::optional<Job> known = cheapest_done(ledger_.reading(), session.node);
  if (!known) {
    if (!session.stopped()) give_jobs(session, 1, reply, now);
    return;
  }
  const std::int64_t id = ledger_.add_recheck(known->id, canary, session.node, now.wall_s);
  if (auto assignment = assign_recheck(recheck_row(ledger_.reading(), id).value(), *known, session, now)) {
    reply.assignments.push_back(std::move(*assignment));
    state.under_way = true;
  }
}

// On another node than the first result, where there is one.
void Reactor::give_rechecks(Session& session, int most, wire::Jobs& reply, Instant now) {
  if (!rechecks_waiting_) return;
  rechecks_waiting_ = false;
  const std::set<std::string> nodes = live_nodes(now);
  for (const RecheckRow& it : open_rechecks(ledger_.reading(), "READY", 1000)) {
    if (it.kind == canary) continue;  // its node went away: the next one that comes gets its own
    rechecks_waiting_ = true;
    if (static_cast<int>(reply.assignments.size()) >= most) return;
    const bool elsewhere =
        it.node == session.node && std::any_of(nodes.begin(), nodes.end(), [&](const std::string& node) { return node != it.node; });
    const std::optional<Job> job = job_by_id(ledger_.reading(), it.job);
    if (elsewhere || !job || job->state != State::done) continue;
    Claim taking(claimant_of(session, most), learned_);
    if (!taking.fits(job->job_class, wall_budget_s(job->campaign))) continue;
    if (auto assignment = assign_recheck(it, *job, session, now)) reply.assignments.push_back(std::move(*assignment));
  }
}

std::optional<wire::Assignment> Reactor::assign_recheck(const RecheckRow& recheck, const Job& job, const Session& session, Instant now) {
  const auto campaign = book_.open(ledger_.reading(), job.campaign);
  if (!campaign) return std::nullopt;
  const wire::LeaseId lease{epoch_, ++counter_};
  ledger_.lease_recheck(recheck.id, lease, session.worker);
  held_[{lease.epoch, lease.counter}] = {job.id,        now.monotonic_s + settings_.lease_timeout_s, now.monotonic_s, 0, recheck.id,
                                         session.worker};
  return assignment_of(job.key, job.id, **campaign, lease, book_.scene_text(job.campaign, job.position), job.attempts + 1, job.step_scale);
}

// By the job's key alone, so that which jobs are computed again depends on no moment.
void Reactor::sample_for_audit(const Job& job, const std::string& node, Instant now) {
  if (settings_.audit_fraction <= 0.0 || job.step_scale != 1.0) return;
  const double draw = static_cast<double>(std::stoull(job.key.substr(0, 13), nullptr, 16)) / static_cast<double>(1ull << 52);
  if (draw >= settings_.audit_fraction || live_nodes(now).size() < 2) return;
  ledger_.add_recheck(job.id, audit, node, now.wall_s);
  rechecks_waiting_ = true;
}

wire::Receipt Reactor::end_recheck(const RecheckRow& recheck, const Job& job, const wire::Completion& completion, Session& session,
                                   Instant now) {
  held_.erase({completion.lease.epoch, completion.lease.counter});
  const bool by_clock = completion.verdict == Verdict::censored && completion.failure_rule == "wall_clock";
  if (by_clock || job.outcome->failure_rule == "wall_clock") {
    ledger_.end_recheck(recheck.id, "FAILED", "a wall clock ended it: no reproducible end", now.wall_s);
    return wire::Receipt::duplicate;
  }
  const bool same = same_physics(*job.outcome, completion);
  const std::string what = same ? "the same result" : difference(*job.outcome, completion);
  ledger_.end_recheck(recheck.id, same ? "PASSED" : "DIFFERED", what, now.wall_s);
  if (!same) {
    const std::string_view kind = recheck.kind == canary ? "CANARY" : "NONDETERMINISM";
    const std::string words = fmt::format("computed again on {} (earlier on {}): {}", session.node, recheck.node, what);
    ledger_.raise_alarm(kind, job.id, words, now.wall_s);
    notice({"alarm", fmt::format("{}: job {} {}", kind, job.id, words), job.id, session.node});
  }
  if (recheck.kind == canary && !same) canary_failed(recheck.node, "its result differs from the known one", now);
  if (recheck.kind == canary && same) {
    canaries_.erase(recheck.node);
    nodes_.erase(recheck.node);
    ledger_.trust(recheck.node);
    for (auto& [peer, other] : roster_)
      if (other.node == recheck.node) other.fast_faults = 0;
    notice({"trusted", fmt::format("{} did its canary: it gets work again", recheck.node), 0, recheck.node});
  }
  if (recheck.kind != repair || !same || completion.shard.empty()) return wire::Receipt::duplicate;
  Outcome place = *job.outcome;
  place.shard = completion.shard;
  place.offset = completion.offset;
  place.length = completion.length;
  place.sha256 = completion.sha256;
  ledger_.move_record(job.id, place);
  return wire::Receipt::accepted;
}

void Reactor::fail_recheck(const RecheckRow& recheck, const Attempt& attempt, Instant now) {
  held_.erase({recheck.lease.epoch, recheck.lease.counter});
  const bool planned = attempt.fault == Fault::planned_stop;
  const std::string what = fmt::format("{}: {}", fault_row(attempt.fault).name, attempt.message);
  if (recheck.kind == canary) {
    ledger_.end_recheck(recheck.id, "FAILED", what, now.wall_s);
    if (planned)
      canaries_[recheck.node].under_way = false;
    else
      canary_failed(recheck.node, what, now);
    return;
  }
  rechecks_waiting_ = true;
  if (planned || recheck.tries < most_tries) return ledger_.reopen_recheck(recheck.id, !planned, what);
  ledger_.end_recheck(recheck.id, "FAILED", what, now.wall_s);
  notice({"alarm", fmt::format("job {} could not be computed again: {}", recheck.job, what), recheck.job});
}

void Reactor::canary_failed(const std::string& node, const std::string& why, Instant now) {
  Canary& state = canaries_[node];
  state.under_way = false;
  state.next_s = now.monotonic_s + canary_pause_s(++state.failed);
  notice({"suspect", fmt::format("{} failed its canary: {}; the next in {:.0f} s", node, why, state.next_s - now.monotonic_s), 0, node});
}

}  // namespace fracfarm
