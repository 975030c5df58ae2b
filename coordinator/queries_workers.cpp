// Workers, nodes, alarms, and results that are computed again.
#include <algorithm>

#include "coordinator/queries.hpp"

namespace fracfarm {
namespace {

WorkerRow worker_of(const Rows& rows) {
  return {rows.integer(0),
          rows.text(1),
          rows.text(2),
          rows.text(3),
          static_cast<int>(rows.integer(4)),
          rows.integer(5) != 0,
          static_cast<std::uint64_t>(rows.integer(6)),
          static_cast<std::uint64_t>(rows.integer(7)),
          rows.real(8),
          rows.text(9),
          static_cast<std::uint64_t>(rows.integer(10))};
}
#define WORKER_COLUMNS "id, peer, instance, node, slots, draining, done, faults, began_at, node_type, memory_bytes"

#define RECHECK_COLUMNS "id, job, kind, state, node, tries, worker, lease_epoch, lease_counter, message"

std::vector<RecheckRow> rechecks_from(Rows rows) {
  std::vector<RecheckRow> list;
  while (rows.next())
    list.push_back({rows.integer(0),
                    rows.integer(1),
                    rows.text(2),
                    rows.text(3),
                    rows.text(4),
                    static_cast<int>(rows.integer(5)),
                    rows.integer(6),
                    {static_cast<std::uint64_t>(rows.integer(7)), static_cast<std::uint64_t>(rows.integer(8))},
                    rows.text(9)});
  return list;
}

std::vector<AttemptRow> attempts_from(Rows rows) {
  std::vector<AttemptRow> list;
  while (rows.next())
    list.push_back({rows.integer(0), rows.integer(1), static_cast<int>(rows.integer(2)), rows.text(3), rows.text(4), rows.text(5),
                    rows.text(6), rows.text(7), rows.real(8), rows.real(9)});
  return list;
}
#define ATTEMPT_COLUMNS                                                                                                  \
  "attempts.id, job, attempt, fault, node, peer, signature, message, attempts.began_at, attempts.ended_at FROM attempts" \
  " LEFT JOIN workers ON workers.id = attempts.worker "

}  // namespace

std::vector<AttemptRow> attempts_of(Database& ledger, std::int64_t job) {
  return attempts_from(ledger.query("SELECT " ATTEMPT_COLUMNS "WHERE job = ?1 ORDER BY attempts.id", job));
}

// Looks at the latest few thousand ends of tries: history has no index by node.
std::vector<AttemptRow> attempts_on(Database& ledger, const std::string& node, int limit) {
  return attempts_from(ledger.query("SELECT " ATTEMPT_COLUMNS
                                    "WHERE attempts.id > (SELECT coalesce(max(id), 0) - 20000 FROM attempts) AND node = ?1"
                                    " ORDER BY attempts.id DESC LIMIT ?2",
                                    node, limit));
}

std::vector<WorkerRow> open_workers(Database& ledger) {
  std::vector<WorkerRow> list;
  Rows rows = ledger.query("SELECT " WORKER_COLUMNS " FROM workers WHERE ended_at IS NULL ORDER BY peer");
  while (rows.next()) list.push_back(worker_of(rows));
  return list;
}

std::optional<WorkerRow> worker_row(Database& ledger, std::int64_t id) {
  Rows rows = ledger.query("SELECT " WORKER_COLUMNS " FROM workers WHERE id = ?1", id);
  if (!rows.next()) return std::nullopt;
  return worker_of(rows);
}

bool had_later_life(Database& ledger, const std::string& peer, const std::string& instance) {
  Rows rows = ledger.query("SELECT EXISTS(SELECT 1 FROM workers WHERE peer = ?1 AND instance > ?2)", peer, instance);
  return rows.next() && rows.integer(0) != 0;
}

std::vector<AlarmRow> alarm_rows(Database& ledger, int limit) {
  std::vector<AlarmRow> list;
  Rows rows = ledger.query("SELECT kind, job, message, raised_at FROM alarms ORDER BY id DESC LIMIT ?1", limit);
  while (rows.next()) list.push_back({rows.text(0), rows.integer(1), rows.text(2), rows.real(3)});
  return list;
}

std::vector<WorkerRow> workers_named(Database& ledger, const std::string& word, int limit) {
  std::vector<WorkerRow> list;
  Rows rows = ledger.query("SELECT " WORKER_COLUMNS " FROM workers WHERE peer = ?1 OR node = ?1 ORDER BY id DESC LIMIT ?2", word, limit);
  while (rows.next()) list.push_back(worker_of(rows));
  return list;
}

std::vector<JobClass> all_classes(Database& ledger) {
  std::vector<JobClass> classes;
  Rows rows = ledger.query("SELECT method, material, load FROM classes ORDER BY 1, 2, 3");
  while (rows.next()) classes.push_back({rows.text(0), rows.text(1), rows.text(2)});
  return classes;
}

std::map<JobClass, std::string> paused_classes(Database& ledger) {
  std::map<JobClass, std::string> paused;
  Rows rows = ledger.query("SELECT method, material, load, paused FROM classes WHERE paused IS NOT NULL");
  while (rows.next()) paused[{rows.text(0), rows.text(1), rows.text(2)}] = rows.text(3);
  return paused;
}

std::vector<NodeRow> node_rows(Database& ledger) {
  std::vector<NodeRow> list;
  Rows rows = ledger.query("SELECT node, blamed, done_since, suspect FROM nodes ORDER BY node");
  while (rows.next())
    list.push_back({rows.text(0), static_cast<std::uint64_t>(rows.integer(1)), static_cast<std::uint64_t>(rows.integer(2)), rows.text(3)});
  return list;
}

std::vector<RecheckRow> open_rechecks(Database& ledger, std::string_view state, int limit) {
  return rechecks_from(ledger.query("SELECT " RECHECK_COLUMNS
                                    " FROM rechecks WHERE state IN ('READY', 'LEASED') AND state = ?1 ORDER BY kind DESC, id LIMIT ?2",
                                    state, limit));
}
std::optional<RecheckRow> recheck_row(Database& ledger, std::int64_t id) {
  std::vector<RecheckRow> rows = rechecks_from(ledger.query("SELECT " RECHECK_COLUMNS " FROM rechecks WHERE id = ?1", id));
  if (rows.empty()) return std::nullopt;
  return rows.front();
}
std::vector<RecheckRow> rechecks_of(Database& ledger, std::int64_t job) {
  return rechecks_from(ledger.query("SELECT " RECHECK_COLUMNS " FROM rechecks WHERE job = ?1 ORDER BY id", job));
}
std::vector<RecheckRow> rechecks_on(Database& ledger, const std::string& node, int limit) {
  return rechecks_from(
      ledger.query("SELECT " RECHECK_COLUMNS " FROM rechecks WHERE kind = 'CANARY' AND node = ?1 ORDER BY id DESC LIMIT ?2", node, limit));
}

std::map<std::string, std::map<std::string, std::uint64_t>> recheck_counts(Database& ledger) {
  std::map<std::string, std::map<std::string, std::uint64_t>> counts;
  Rows rows = ledger.query("SELECT kind, state, count(*) FROM rechecks GROUP BY 1, 2");
  while (rows.next()) counts[rows.text(0)][rows.text(1)] = static_cast<std::uint64_t>(rows.integer(2));
  return counts;
}

// Of the latest results with the whole time step that ended by physics, the one that took least.
std::optional<Job> cheapest_done(Database& ledger, const std::string& not_on_node) {
  std::int64_t id = 0;
  {
    Rows rows = ledger.query(
        "SELECT jobs.id FROM jobs JOIN workers ON workers.id = worker LEFT JOIN rules ON rules.id = rule"
        " WHERE jobs.id > (SELECT coalesce(max(id), 0) - 5000 FROM jobs) AND state = 'DONE' AND shard IS NOT NULL AND step_scale = 1"
        " AND node <> ?1 AND rules.name IS NOT 'wall_clock' ORDER BY wall_s, jobs.id LIMIT 1",
        not_on_node);
    if (!rows.next()) return std::nullopt;
    id = rows.integer(0);
  }
  return job_by_id(ledger, id);
}

}  // namespace fracfarm
