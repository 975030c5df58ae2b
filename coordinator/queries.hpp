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
  std::int64_t first_id = 0;  // of position 0
};
std::vector<CampaignRow> campaign_rows(Database& ledger);
std::optional<CampaignRow> campaign_row(Database& ledger, std::int64_t id);

std::vector<SeriesPlace> series_places(Database& ledger, const std::string& identity);
// DONE ones of the jobs first, first + stride, ..., last: walks the rows between.
std::uint64_t count_done(Database& ledger, std::int64_t first, std::int64_t last, std::int64_t stride);

std::vector<Lane> ready_lanes(Database& ledger, int priority, std::int64_t after_next, int limit);  // in the order of claims
std::optional<Lane> lane_of(Database& ledger, std::int64_t job);                                    // the lane that has this job

struct CountRow {
  std::int64_t campaign = 0;
  State state = State::ready;
  std::string verdict;
  JobClass job_class;
  std::uint64_t n = 0;
};
std::vector<CountRow> count_rows(Database& ledger);    // the counters
std::vector<CountRow> recount_rows(Database& ledger);  // the same by a scan of every job and lane: for tests and doubt
std::map<std::string, std::uint64_t> fault_counts(Database& ledger);
std::map<JobClass, std::map<std::string, std::uint64_t>> faults_by_class(Database& ledger);

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
  std::string method = {};
};
std::vector<Job> jobs_where(Database& ledger, const JobFilter& filter);    // those that have been touched
std::vector<Lane> lanes_where(Database& ledger, const JobFilter& filter);  // the others; `after` and `limit` are ids' business, not lanes'
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
  std::string node_type;
  std::uint64_t memory_bytes = 0;
};
std::vector<WorkerRow> open_workers(Database& ledger);  // not ended
std::optional<WorkerRow> worker_row(Database& ledger, std::int64_t id);
std::vector<WorkerRow> workers_named(Database& ledger, const std::string& word, int limit);  // of a peer or node, the newest first
std::vector<AttemptRow> attempts_on(Database& ledger, const std::string& node, int limit);   // the newest first
bool had_later_life(Database& ledger, const std::string& peer, const std::string& instance);  // instances sort as they were started

struct AlarmRow {
  std::string kind;
  std::int64_t job = 0;
  std::string message;
  double raised_at = 0.0;
};
std::vector<AlarmRow> alarm_rows(Database& ledger, int limit);

std::vector<JobClass> all_classes(Database& ledger);
std::map<JobClass, std::string> paused_classes(Database& ledger);  // and why

struct NodeRow {
  std::string node;
  std::uint64_t blamed = 0;      // failures of jobs that other nodes then did
  std::uint64_t done_since = 0;  // results since the last of them
  std::string suspect;           // why it gets a canary before work; empty: it is trusted
};
std::vector<NodeRow> node_rows(Database& ledger);

struct RecheckRow {
  std::int64_t id = 0;
  std::int64_t job = 0;
  std::string kind;   // CANARY, AUDIT, REPAIR
  std::string state;  // READY, LEASED, PASSED, DIFFERED, FAILED
  std::string node;
  int tries = 0;
  std::int64_t worker = 0;
  wire::LeaseId lease;
  std::string message;
};
std::vector<RecheckRow> open_rechecks(Database& ledger, std::string_view state, int limit);  // READY or LEASED
std::optional<RecheckRow> recheck_row(Database& ledger, std::int64_t id);
std::vector<RecheckRow> rechecks_of(Database& ledger, std::int64_t job);
std::vector<RecheckRow> rechecks_on(Database& ledger, const std::string& node, int limit);     // canaries of it, the newest first
std::map<std::string, std::map<std::string, std::uint64_t>> recheck_counts(Database& ledger);  // by kind and state
std::optional<Job> cheapest_done(Database& ledger, const std::string& not_on_node);            // a known result for a canary

// What results of a class took.
struct Learned {
  std::uint64_t n = 0;
  double mean_s = 0.0;
  double p99_s = 0.0;  // upper edge of its quarter octave
  double mean_bytes = 0.0;
};
std::map<JobClass, Learned> learned_times(Database& ledger);  // over all nodes
// By class and type of node.
std::map<std::pair<JobClass, std::string>, Learned> learned_times_by_node(Database& ledger);

}  // namespace fracfarm
