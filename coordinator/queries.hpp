// What can be asked of the ledger: SQL that only reads. Nothing here scans the jobs but where it says so.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/job.hpp"
#include "coordinator/ledger_sqlite.hpp"

namespace fracfarm {

std::string meta_value(Database& ledger, const std::string& name);  // empty where it is not there

struct CampaignRow {
  std::int64_t id = 0;
  std::string name;
  std::string text;
  std::string build_id;
  std::uint64_t total = 0;
  std::uint64_t expanded = 0;
  std::uint64_t shared = 0;
};
std::vector<CampaignRow> campaign_rows(Database& ledger);
std::optional<CampaignRow> campaign_row(Database& ledger, std::int64_t id);
std::optional<CampaignRow> next_unexpanded(Database& ledger);

struct CountRow {
  std::int64_t campaign = 0;
  State state = State::ready;
  std::string verdict;
  JobClass job_class;
  std::uint64_t n = 0;
};
std::vector<CountRow> count_rows(Database& ledger);    // the counters
std::vector<CountRow> recount_rows(Database& ledger);  // the same by a scan of every job: for tests and doubt
std::map<std::string, std::uint64_t> fault_counts(Database& ledger);

std::optional<Job> job_by_id(Database& ledger, std::int64_t id);
std::optional<Job> job_by_key(Database& ledger, const std::string& hex_key);
std::optional<Job> job_by_lease(Database& ledger, wire::LeaseId lease);  // the job whose current lease it is
std::vector<Job> jobs_by_key_prefix(Database& ledger, const std::string& hex_prefix, int limit);

// Jobs by id from after `after`; empty fields match everything.
struct JobFilter {
  std::optional<State> state;
  std::string material;
  std::string load;
  std::string fault;     // its last try ended so
  std::string campaign;  // name
  std::int64_t after = 0;
  int limit = 50;
};
std::vector<Job> jobs_where(Database& ledger, const JobFilter& filter);
std::vector<Job> leased_jobs(Database& ledger);
std::vector<Job> leased_by_peer(Database& ledger, const std::string& peer);
std::vector<Job> waiting_jobs(Database& ledger);                                  // RETRY_WAIT
std::vector<Job> recorded_jobs(Database& ledger, std::int64_t after, int limit);  // DONE with a record, by id

// READY jobs in the order of claims, after (priority, id).
struct ClaimCursor {
  std::int64_t priority = INT32_MAX;
  std::int64_t id = 0;
};
std::vector<Job> ready_jobs(Database& ledger, const ClaimCursor& after, int limit);

struct AttemptRow {
  std::int64_t id = 0;
  std::int64_t job = 0;
  int attempt = 0;
  std::string fault;
  std::string node;
  std::string peer;
  std::string signature;
  std::string message;
  double began_at = 0.0;
  double ended_at = 0.0;
};
std::vector<AttemptRow> attempts_of(Database& ledger, std::int64_t job);

struct WorkerRow {
  std::int64_t id = 0;
  std::string peer;
  std::string instance;
  std::string node;
  int slots = 0;
  bool draining = false;
  std::uint64_t done = 0;
  std::uint64_t faults = 0;
  double began_at = 0.0;
};
std::vector<WorkerRow> open_workers(Database& ledger);  // not ended
std::optional<WorkerRow> worker_row(Database& ledger, std::int64_t id);

struct AlarmRow {
  std::string kind;
  std::int64_t job = 0;
  std::string message;
  double raised_at = 0.0;
};
std::vector<AlarmRow> alarm_rows(Database& ledger, int limit);

// What results of a class took.
struct Learned {
  std::uint64_t n = 0;
  double mean_s = 0.0;
  double p99_s = 0.0;  // upper edge of its quarter octave
  double mean_bytes = 0.0;
};
std::map<JobClass, Learned> learned_times(Database& ledger);

}  // namespace fracfarm
