#include "coordinator/queries.hpp"

#include <fmt/format.h>

#include "coordinator/ledger.hpp"

namespace fracfarm {
namespace {

#define JOB_COLUMNS                                                                                                                  \
  "jobs.id, key, campaign, position, method, material, load, oblique, sample_id, state, priority, attempts, forgiven, step_scale, "  \
  "wait_s, lease_epoch, lease_counter, worker, leased_at, verdict, time_to_failure, rules.name, peak_stress, steps, cpu_s, wall_s, " \
  "done_at, shards.name, offset, length, sha256, memory_floor"
#define FROM_JOBS " FROM jobs JOIN classes ON classes.id = class LEFT JOIN rules ON rules.id = rule LEFT JOIN shards ON shards.id = shard "

Outcome outcome_of(const Rows& rows) {
  Outcome outcome;
  outcome.verdict = verdict_by_name(rows.text(19)).value_or(Verdict::censored);
  outcome.time_to_failure = rows.maybe_real(20);
  outcome.failure_rule = rows.text(21);
  outcome.peak_stress = rows.real(22);
  outcome.steps = rows.integer(23);
  outcome.cpu_s = rows.real(24);
  outcome.wall_s = rows.real(25);
  outcome.done_at = rows.real(26);
  outcome.shard = rows.text(27);
  outcome.offset = static_cast<std::uint64_t>(rows.integer(28));
  outcome.length = static_cast<std::uint64_t>(rows.integer(29));
  outcome.sha256 = hex_of_bytes(rows.text(30));
  return outcome;
}

Job job_of(const Rows& rows) {
  Job job;
  job.id = rows.integer(0);
  job.key = hex_of_bytes(rows.text(1));
  job.campaign = rows.integer(2);
  job.position = static_cast<std::uint64_t>(rows.integer(3));
  job.job_class = {rows.text(4), rows.text(5), rows.text(6)};
  job.crack_set = rows.integer(7) ? "oblique" : "orthogonal";
  job.sample_id = static_cast<std::uint64_t>(rows.integer(8));
  job.state = state_by_name(rows.text(9)).value();
  job.priority = static_cast<int>(rows.integer(10));
  job.attempts = static_cast<int>(rows.integer(11));
  job.forgiven = rows.integer(12);
  job.step_scale = rows.real(13);
  job.wait_s = rows.real(14);
  job.lease = {static_cast<std::uint64_t>(rows.integer(15)), static_cast<std::uint64_t>(rows.integer(16))};
  job.worker = rows.integer(17);
  job.leased_at = rows.real(18);
  job.memory_floor = static_cast<std::uint64_t>(rows.integer(31));
  if (!rows.null(19)) job.outcome = outcome_of(rows);
  return job;
}

std::optional<Job> first_job(Rows rows) {
  if (!rows.next()) return std::nullopt;
  return job_of(rows);
}

std::vector<Job> all_jobs(Rows rows) {
  std::vector<Job> jobs;
  while (rows.next()) jobs.push_back(job_of(rows));
  return jobs;
}

CampaignRow campaign_of(const Rows& rows) {
  return {rows.integer(0),
          rows.text(1),
          rows.text(2),
          rows.text(3),
          static_cast<std::uint64_t>(rows.integer(4)),
          static_cast<std::uint64_t>(rows.integer(5)),
          static_cast<std::uint64_t>(rows.integer(6)),
          rows.integer(7)};
}
#define CAMPAIGN_COLUMNS "id, name, text, build_id, total, expanded, shared, first_id"

std::vector<CountRow> counts_of(Rows rows) {
  std::vector<CountRow> counts;
  while (rows.next())
    counts.push_back({rows.integer(0),
                      state_by_name(rows.text(1)).value(),
                      rows.text(2),
                      {rows.text(3), rows.text(4), rows.text(5)},
                      static_cast<std::uint64_t>(rows.integer(6))});
  return counts;
}

}  // namespace

std::string meta_value(Database& ledger, const std::string& name) {
  Rows rows = ledger.query("SELECT value FROM meta WHERE name = ?1", name);
  return rows.next() ? rows.text(0) : std::string();
}

std::vector<CampaignRow> campaign_rows(Database& ledger) {
  std::vector<CampaignRow> list;
  Rows rows = ledger.query("SELECT " CAMPAIGN_COLUMNS " FROM campaigns ORDER BY id");
  while (rows.next()) list.push_back(campaign_of(rows));
  return list;
}

std::optional<CampaignRow> campaign_row(Database& ledger, std::int64_t id) {
  Rows rows = ledger.query("SELECT " CAMPAIGN_COLUMNS " FROM campaigns WHERE id = ?1", id);
  if (!rows.next()) return std::nullopt;
  return campaign_of(rows);
}

std::vector<CountRow> count_rows(Database& ledger) {
  return counts_of(
      ledger.query("SELECT campaign, state, verdict, method, material, load, n FROM counts JOIN classes ON classes.id = class WHERE n > 0"
                   " ORDER BY 1, 2, 3, 4, 5, 6"));
}
std::vector<CountRow> recount_rows(Database& ledger) {
  return counts_of(
      ledger.query("SELECT campaign, state, verdict, method, material, load, sum(n) FROM"
                   " (SELECT campaign, state, coalesce(verdict, '') AS verdict, class, count(*) AS n FROM jobs GROUP BY 1, 2, 3, 4"
                   "  UNION ALL SELECT campaign, state, '', class, (last - next) / stride + 1 FROM lanes)"
                   " JOIN classes ON classes.id = class GROUP BY 1, 2, 3, 4, 5, 6 ORDER BY 1, 2, 3, 4, 5, 6"));
}

std::map<std::string, std::uint64_t> fault_counts(Database& ledger) {
  std::map<std::string, std::uint64_t> counts;
  Rows rows = ledger.query("SELECT fault, sum(n) FROM fault_tally GROUP BY fault");
  while (rows.next()) counts[rows.text(0)] = static_cast<std::uint64_t>(rows.integer(1));
  return counts;
}

std::map<JobClass, std::map<std::string, std::uint64_t>> faults_by_class(Database& ledger) {
  std::map<JobClass, std::map<std::string, std::uint64_t>> counts;
  Rows rows = ledger.query("SELECT method, material, load, fault, n FROM fault_tally JOIN classes ON classes.id = class");
  while (rows.next()) counts[{rows.text(0), rows.text(1), rows.text(2)}][rows.text(3)] = static_cast<std::uint64_t>(rows.integer(4));
  return counts;
}

std::optional<Job> job_by_id(Database& ledger, std::int64_t id) {
  return first_job(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE jobs.id = ?1", id));
}

std::optional<Job> job_by_key(Database& ledger, const std::string& hex_key) {
  const std::string key = bytes_of_hex(hex_key);
  return first_job(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE substr(key, 1, 16) = substr(?1, 1, 16) AND key = ?1", Blob{key}));
}

std::optional<Job> job_by_lease(Database& ledger, wire::LeaseId lease) {
  return first_job(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE state = 'LEASED' AND lease_epoch = ?1 AND lease_counter = ?2",
                                lease.epoch, lease.counter));
}

std::vector<Job> jobs_by_key_prefix(Database& ledger, const std::string& hex_prefix, int limit) {
  const bool odd = hex_prefix.size() % 2;
  const std::string low = bytes_of_hex(hex_prefix + (odd ? "0" : "")),
                    high = bytes_of_hex(hex_prefix + (odd ? "f" : "")) + std::string(32, '\xff');
  if (low.empty()) return {};
  return all_jobs(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS
                               "WHERE substr(key, 1, 16) BETWEEN substr(?1, 1, 16) AND substr(?2, 1, 16) AND key BETWEEN ?1 AND ?2"
                               " ORDER BY substr(key, 1, 16) LIMIT ?3",
                               Blob{low}, Blob{high}, limit));
}

// Scans where the state is not one of the few that have an index; `limit` ends it early.
std::vector<Job> jobs_where(Database& ledger, const JobFilter& filter) {
  std::string sql = "SELECT " JOB_COLUMNS FROM_JOBS "WHERE jobs.id > ?1";
  if (filter.state) sql += fmt::format(" AND state = '{}'", state_row(*filter.state).name);
  if (!filter.material.empty()) sql += " AND material = ?2";
  if (!filter.load.empty()) sql += " AND load = ?3";
  if (!filter.method.empty()) sql += " AND method = ?6";
  if (!filter.fault.empty()) sql += " AND ?4 = (SELECT fault FROM attempts WHERE job = jobs.id ORDER BY attempts.id DESC LIMIT 1)";
  if (!filter.campaign.empty()) sql += " AND campaign IN (SELECT id FROM campaigns WHERE name = ?5)";
  sql += " ORDER BY jobs.id LIMIT ?7";
  return all_jobs(
      ledger.query(sql, filter.after, filter.material, filter.load, filter.fault, filter.campaign, filter.method, filter.limit));
}

std::vector<Job> leased_jobs(Database& ledger) { return all_jobs(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE state = 'LEASED'")); }
std::vector<Job> leased_by_peer(Database& ledger, const std::string& peer) {
  return all_jobs(
      ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE state = 'LEASED' AND worker IN (SELECT id FROM workers WHERE peer = ?1)", peer));
}
std::vector<Job> waiting_jobs(Database& ledger) {
  return all_jobs(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE state = 'RETRY_WAIT'"));
}
std::vector<Job> recorded_jobs(Database& ledger, std::int64_t after, int limit) {
  return all_jobs(
      ledger.query("SELECT " JOB_COLUMNS FROM_JOBS "WHERE jobs.id > ?1 AND shard IS NOT NULL ORDER BY jobs.id LIMIT ?2", after, limit));
}

std::vector<Job> ready_jobs(Database& ledger, const ClaimCursor& after, int limit) {
  return all_jobs(ledger.query("SELECT " JOB_COLUMNS FROM_JOBS
                               "WHERE state = 'READY' AND priority <= ?1 AND (priority < ?1 OR jobs.id > ?2)"
                               " ORDER BY priority DESC, jobs.id LIMIT ?3",
                               after.priority, after.id, limit));
}

}  // namespace fracfarm
