// What must hold in every committed state of the ledger.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/retry_policy.hpp"
#include "tests/simulation/watch.hpp"

namespace fracfarm::simulation {
namespace {

std::string counts_text(const std::vector<CountRow>& rows) {
  std::string text;
  for (const CountRow& row : rows)
    text += fmt::format("{} {} {} {} {} {}; ", row.campaign, state_row(row.state).name, row.verdict, row.job_class.material,
                        row.job_class.load, row.n);
  return text;
}

bool ended_by_coordinator(const AttemptRow& row) { return row.signature == "lease_timeout" || row.signature == "worker_restarted"; }

}  // namespace

void Watch::look(Database& ledger, double now) {
  ++looks_;
  look_at_counts(ledger);
  look_at_jobs(ledger);
  Rows rows = ledger.query("SELECT job, max(id) FROM attempts WHERE id > ?1 GROUP BY job", last_attempt_);
  std::set<std::int64_t> jobs;
  std::int64_t newest = last_attempt_;
  while (rows.next()) jobs.insert(rows.integer(0)), newest = std::max(newest, rows.integer(1));
  for (const std::int64_t id : jobs)
    for (const AttemptRow& row : attempts_of(ledger, id))
      if (row.id > last_attempt_) look_at_attempt(*job_by_id(ledger, id), row, now);
  last_attempt_ = newest;
}

// I5, I6, I7.
void Watch::look_at_counts(Database& ledger) {
  state_ = counts_text(recount_rows(ledger));
  if (const std::string counted = counts_text(count_rows(ledger)); counted != state_)
    return broken(fmt::format("I5: counters {} but a recount {}", counted, state_));
  std::uint64_t total = 0, made = 0;
  for (const CountRow& row : count_rows(ledger)) total += row.n;
  for (const CampaignRow& campaign : campaign_rows(ledger)) made += campaign.expanded - campaign.shared;
  if (total != made) return broken(fmt::format("I6: {} jobs, {} were submitted", total, made));
  faults_ = 0;
  for (const auto& [fault, n] : fault_counts(ledger)) faults_ += n;
  Rows rows = ledger.query("SELECT count(*) FROM attempts");
  const std::uint64_t on_record = rows.next() ? static_cast<std::uint64_t>(rows.integer(0)) : 0;
  if (faults_ != on_record) broken(fmt::format("I7: {} faults counted, {} on record", faults_, on_record));
}

void Watch::look_at_jobs(Database& ledger) {
  std::map<std::int64_t, std::vector<AttemptRow>> histories;
  std::set<LeaseKey> current;
  std::map<std::string, const Job*> by_key;
  JobFilter all;
  all.limit = 100'000;
  const std::vector<Job> jobs = jobs_where(ledger, all);
  for (const Job& job : jobs) {
    by_key[job.key] = &job;
    if (job.outcome)
      look_at_done(job);
    else if (done_.contains(job.id))
      broken(fmt::format("I1: job {} was DONE and is {}", job.id, state_row(job.state).name));
    if (job.state == State::leased && !current.insert({job.lease.epoch, job.lease.counter}).second)
      broken(fmt::format("I4: lease {}.{} stands for two jobs", job.lease.epoch, job.lease.counter));
    if (job.attempts > 1 || job.state == State::quarantined) look_at_history(job, attempts_of(ledger, job.id));
  }
  for (const auto& [key, digest] : promised_) {
    const auto job = by_key.find(key);
    const bool kept = job != by_key.end() && job->second->outcome && (digest.empty() || job->second->outcome->sha256 == digest);
    if (!kept) broken(fmt::format("I2: the result of {:.12} was acknowledged and is not in the ledger", key));
  }
}

// I1 and I3.
void Watch::look_at_done(const Job& job) {
  const auto [first, is_new] = done_.try_emplace(job.id, job.outcome->sha256);
  if (!is_new && first->second != job.outcome->sha256) broken(fmt::format("I1: job {} became DONE twice, with two digests", job.id));
  const auto bytes = stored_.find({job.outcome->shard, job.outcome->offset});
  if (bytes == stored_.end() || bytes->second != job.outcome->sha256)
    broken(fmt::format("I3: job {} is DONE, and {} has no such bytes", job.id, job.outcome->shard));
}

void Watch::look_at_history(const Job& job, std::vector<AttemptRow> history) {
  if (static_cast<int>(history.size()) > job.attempts)
    broken(fmt::format("I7: job {} has {} ends of {} tries", job.id, history.size(), job.attempts));
  std::erase_if(history, [&](const AttemptRow& row) { return row.id <= job.forgiven || row.fault == "PLANNED_STOP"; });
  if (job.state == State::quarantined && (history.empty() || decide_retry(job, history, 3).state != State::quarantined))
    broken(fmt::format("I10: job {} is quarantined, but not by faults that count", job.id));
}

// A lease ends by time only where its holder was silent; what was given back is no fault.
void Watch::look_at_attempt(const Job& job, const AttemptRow& row, double now) {
  const auto of = tries_.find({job.key, row.attempt});
  if (of == tries_.end()) return broken(fmt::format("I7: job {} has an end of try {}, which nobody was given", job.id, row.attempt));
  const Given& lease = given_.at(of->second);
  if (row.signature == "lease_timeout" && now - lease.heard_at < lease_timeout_s_ - 1e-6)
    broken(fmt::format("I4: job {} was taken from {} {:.1f} s after it was heard", job.id, lease.peer, now - lease.heard_at));
  if (row.signature == "worker_restarted" && lease.life == lives_[lease.peer])
    broken(fmt::format("I4: job {} was taken from {}, which has not started again", job.id, lease.peer));
  if (ended_by_coordinator(row) && left_.contains({lease.peer, lease.life}))
    broken(fmt::format("I10: {} left in good order, and job {} is on record as {}", lease.peer, job.id, row.signature));
  if (row.fault != "PLANNED_STOP" && lease.returned && !ended_by_coordinator(row))
    broken(fmt::format("I10: job {} was given back and is on record as {}", job.id, row.fault));
}

}  // namespace fracfarm::simulation
