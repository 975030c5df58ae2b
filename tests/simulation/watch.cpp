// The promises between coordinator and workers; what must hold in the ledger is in invariants.cpp.
#include "tests/simulation/watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/claim.hpp"

namespace fracfarm::simulation {

Watch::Given* Watch::given(const wire::LeaseId& lease) {
  const auto found = given_.find({lease.epoch, lease.counter});
  return found == given_.end() ? nullptr : &found->second;
}

void Watch::asked(const std::string& peer, const wire::Request& request) {
  const auto returned = [&](const std::vector<wire::LeaseId>& leases) {
    for (const wire::LeaseId& it : leases)
      if (Given* lease = given(it); lease && lease->peer == peer) lease->returned = true;
  };
  if (const auto* next = std::get_if<wire::Next>(&request)) returned(next->returned);
  if (const auto* bye = std::get_if<wire::Bye>(&request)) returned(bye->returned);
}

void Watch::answered(const std::string& peer, const wire::RequestEnvelope& asked, const wire::Reply& reply, std::uint64_t epoch, double now,
                     Database& ledger) {
  if (const auto* jobs = std::get_if<wire::Jobs>(&reply)) {
    const bool said_again = served_.contains(fmt::format("{} {} {}", peer, asked.request_id, epoch));
    look_at_assignments(peer, asked, *jobs, epoch, now, ledger);
    if (const auto* next = std::get_if<wire::Next>(&asked.request); next && !said_again) look_at_receipts(*next, *jobs, ledger);
  }
  const auto* hello = std::get_if<wire::Hello>(&asked.request);
  const auto* beat = std::get_if<wire::Beat>(&asked.request);
  const auto* welcome = std::get_if<wire::Welcome>(&reply);
  const auto* kept = std::get_if<wire::BeatReply>(&reply);
  if (!(hello && welcome) && !(beat && kept)) return;
  const std::vector<wire::HeldLease>& held = hello ? hello->held : beat->held;
  if (!heard_.insert(fmt::format("{} {} {}", peer, asked.request_id, epoch)).second) return;  // said again: no news
  look_at_rulings(peer, held, welcome ? welcome->rulings : kept->rulings, ledger);
  for (const wire::HeldLease& it : held)
    if (Given* lease = given(it.lease); lease && lease->peer == peer) lease->heard_at = now;
}

// A repeated claim gets the leases that it got; every other lease is a new one, and fits the allocation of whoever gets it.
void Watch::look_at_assignments(const std::string& peer, const wire::RequestEnvelope& asked, const wire::Jobs& jobs, std::uint64_t epoch,
                                double now, Database& ledger) {
  std::vector<LeaseKey> leases;
  for (const wire::Assignment& it : jobs.assignments) leases.emplace_back(it.lease.epoch, it.lease.counter);
  const auto [before, first] = served_.try_emplace(fmt::format("{} {} {}", peer, asked.request_id, epoch), leases);
  if (!first && before->second != leases) return broken(fmt::format("I4: one claim of {} was served twice, with different leases", peer));
  if (!first) return;
  const auto* next = std::get_if<wire::Next>(&asked.request);
  for (const wire::Assignment& it : jobs.assignments) {
    const LeaseKey lease{it.lease.epoch, it.lease.counter};
    const std::optional<Job> job = job_by_key(ledger, it.key);
    const bool again = job && job->state == State::done;
    const Given made{it.key, peer, asked.request_id / requests_of_a_life, it.attempt, now, false, again};
    if (!given_.try_emplace(lease, made).second) return broken(fmt::format("I4: lease {}.{} was given twice", lease.first, lease.second));
    if (again) continue;
    tries_[{it.key, it.attempt}] = lease;
    if (!job || !(job->lease == it.lease)) return broken("I4: an assignment of a job that the ledger does not lease so");
    std::uint64_t results = 0;
    for (const auto& [job_class, learned] : learned_times(ledger)) results += learned.n;
    const bool unknown = results < enough_history;  // then the hard budget is all that is known
    if (next && next->remaining_s >= 0.0 && unknown && next->remaining_s < wall_budget_s_)
      return broken(fmt::format("I9: a job that may take {} s was handed to {}, which has {} s", wall_budget_s_, peer, next->remaining_s));
  }
}

// Whoever holds a lease by the ledger keeps it.
void Watch::look_at_rulings(const std::string& peer, const std::vector<wire::HeldLease>& held, const std::vector<wire::Ruling>& rulings,
                            Database& ledger) {
  for (std::size_t at = 0; at < std::min(held.size(), rulings.size()); ++at) {
    const std::optional<Job> job = job_by_lease(ledger, held[at].lease);
    if (!job || job->state != State::leased || job->key != held[at].key) continue;
    const std::optional<WorkerRow> holder = worker_row(ledger, job->worker);
    const bool own = holder && holder->peer == peer;
    if (own != (rulings[at] == wire::Ruling::adopt))
      return broken(fmt::format("I4: {} was told to {} job {}, which {}", peer, own ? "abandon" : "keep", job->id,
                                own ? "it holds" : "another holds"));
  }
}

// A fault ends the try that it names and no other.
void Watch::look_at_receipts(const wire::Next& next, const wire::Jobs& jobs, Database& ledger) {
  if (jobs.receipts.size() != next.completed.size() + next.failed.size())
    return broken(fmt::format("I2: {} receipts for {} results", jobs.receipts.size(), next.completed.size() + next.failed.size()));
  for (std::size_t at = 0; at < next.failed.size(); ++at) {
    const wire::Failed& failed = next.failed[at];
    const Given* lease = given(failed.lease);
    if (jobs.receipts[next.completed.size() + at] != wire::Receipt::accepted || !lease || lease->again) continue;
    const std::vector<AttemptRow> history = attempts_of(ledger, job_by_key(ledger, failed.key)->id);
    if (history.empty() || history.back().attempt != lease->attempt)
      return broken(fmt::format("I4: a fault of try {} of a job ended another try of it", lease->attempt));
  }
}

void Watch::sent(const std::string&, const wire::RequestEnvelope& asked, const wire::Reply& reply) {
  const auto* next = std::get_if<wire::Next>(&asked.request);
  const auto* jobs = std::get_if<wire::Jobs>(&reply);
  if (!next || !jobs) return;
  for (std::size_t at = 0; at < std::min(next->completed.size(), jobs->receipts.size()); ++at) {
    const wire::Completion& told = next->completed[at];
    const Given* lease = given(told.lease);
    if (lease && lease->again) continue;
    if (jobs->receipts[at] == wire::Receipt::accepted) promised_[told.key] = told.sha256;
    if (jobs->receipts[at] == wire::Receipt::duplicate) promised_.try_emplace(told.key, "");
  }
}

// Somebody with a key of his own and another's routing id: nothing that he says may be taken for the other's.
void Watch::stranger_answered(const wire::Reply& reply) {
  if (!std::holds_alternative<wire::Refusal>(reply) && !std::holds_alternative<wire::ByeReply>(reply))
    broken("I4: a stranger was taken for a worker whose routing id it used");
}

}  // namespace fracfarm::simulation
