// What must hold after every step (farm's invariants I1 to I10).
#include <fmt/format.h>

#include "coordinator/claim.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/retry_policy.hpp"
#include "tests/simulation/world.hpp"

namespace fracfarm::simulation {
namespace {

std::string counts_text(const std::vector<CountRow>& rows) {
  std::string text;
  for (const CountRow& row : rows)
    text += fmt::format("{} {} {} {} {} {}; ", row.campaign, state_row(row.state).name, row.verdict, row.job_class.material,
                        row.job_class.load, row.n);
  return text;
}

}  // namespace

void World::check_assignment(const Worker& worker, const wire::Assignment& it) {
  const auto [given, is_new] =
      leases_given_.try_emplace({it.lease.epoch, it.lease.counter}, fmt::format("{} to {}", it.key, worker.instance));
  // A repeated reply gives the same lease to the same worker again; anything else is a lease given twice.
  if (!is_new && given->second != fmt::format("{} to {}", it.key, worker.instance) && given->second.substr(0, 64) != it.key)
    broken(fmt::format("I4: lease {}.{} was given for two jobs", it.lease.epoch, it.lease.counter));
  const std::optional<Job> job = job_by_key(ledger_.reading(), it.key);
  if (!job) return broken("an assignment of a job that is not in the ledger");
  const double longest = longest_s({job->id, job->job_class, 3600.0, {}}, learned_times(ledger_.reading()));
  // History may have grown by a batch since the reactor last looked; only the hard budget is certain.
  if (is_new && worker.remaining_s >= 0.0 && longest >= 3600.0 && worker.remaining_s < 3600.0)
    broken("I9: a worker was handed what it cannot finish");
}

// I1, I2, I3 for one DONE job.
void World::check_done(const Job& job) {
  const std::string& digest = job.outcome->sha256;
  const auto [first, is_new] = done_digest_.try_emplace(job.id, digest);
  if (!is_new && first->second != digest) broken(fmt::format("I1: job {} became DONE twice, with two digests", job.id));
  if (!produced_[job.key].contains(digest)) broken(fmt::format("I3: job {} is DONE with bytes that nobody wrote", job.id));
}

void World::check() {
  Database& ledger = ledger_.reading();
  const std::string counted = counts_text(count_rows(ledger)), recounted = counts_text(recount_rows(ledger));
  if (counted != recounted) broken(fmt::format("I5: counters {} but a recount {}", counted, recounted));
  std::uint64_t total = 0;
  for (const CountRow& row : recount_rows(ledger)) total += row.n;
  const CampaignRow campaign = campaign_row(ledger, 1).value();
  if (total != campaign.expanded - campaign.shared)
    broken(fmt::format("I6: {} jobs, {} were submitted", total, campaign.expanded - campaign.shared));

  std::uint64_t rows_of_faults = 0;
  for (const Job& job : jobs_where(ledger, {{}, "", "", "", "", 0, 10000})) {
    if (job.outcome)
      check_done(job);
    else if (done_digest_.contains(job.id))
      broken(fmt::format("I1: job {} was DONE and is {}", job.id, state_row(job.state).name));
    std::vector<AttemptRow> history = attempts_of(ledger, job.id);
    rows_of_faults += history.size();
    if (static_cast<int>(history.size()) > job.attempts)
      broken(fmt::format("I7: job {} has {} ends of {} tries", job.id, history.size(), job.attempts));
    std::erase_if(history, [&](const AttemptRow& row) { return row.id <= job.forgiven || row.fault == "PLANNED_STOP"; });
    if (job.state == State::quarantined && (history.empty() || decide_retry(job, history, 3).state != State::quarantined))
      broken(fmt::format("I10: job {} is quarantined, but not by faults that count", job.id));
  }
  std::uint64_t counted_faults = 0;
  for (const auto& [fault, n] : fault_counts(ledger)) counted_faults += n;
  if (counted_faults != rows_of_faults) broken(fmt::format("I7: {} faults counted, {} on record", counted_faults, rows_of_faults));
  for (const auto& [key, digest] : acknowledged_) {
    const std::optional<Job> job = job_by_key(ledger, key);
    if (!job || !job->outcome || job->outcome->sha256 != digest)
      broken(fmt::format("I2: the result of {:.12} was acknowledged and is not in the ledger", key));
  }
  trace(recounted);
}

std::uint64_t World::done() const { return done_digest_.size(); }

std::uint64_t World::faults_seen() const {
  std::uint64_t n = 0;
  for (const auto& [fault, count] : fault_counts(const_cast<Ledger&>(ledger_).reading())) n += count;
  return n;
}

}  // namespace fracfarm::simulation
