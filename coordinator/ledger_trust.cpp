// The ledger's writing of what results and nodes are worth: alarms, blame, suspicion, results that are computed again, paused classes.
#include "coordinator/ledger.hpp"

namespace fracfarm {

void Ledger::raise_alarm(std::string_view kind, std::int64_t job, const std::string& message, double wall_s) {
  database_.run("INSERT INTO alarms(kind, job, message, raised_at) VALUES(?1, nullif(?2, 0), ?3, ?4)", kind, job, bounded(message), wall_s);
}

void Ledger::move_record(std::int64_t job, const Outcome& place) {
  const std::int64_t shard = shard_id(place.shard);
  const std::string digest = bytes_of_hex(place.sha256);
  database_.run("UPDATE jobs SET shard = ?2, offset = ?3, length = ?4, sha256 = ?5 WHERE id = ?1 AND state = 'DONE'", job, shard,
                place.offset, place.length, Blob{digest});
}

void Ledger::pause_class(const JobClass& job_class, const std::string& why, double wall_s) {
  database_.run("UPDATE classes SET paused = ?2, paused_at = ?3 WHERE id = ?1", class_id(job_class), bounded(why), wall_s);
}
void Ledger::resume_class(const JobClass& job_class) {
  database_.run("UPDATE classes SET paused = NULL, paused_at = NULL WHERE id = ?1", class_id(job_class));
}

void Ledger::blame(const std::string& node) {
  database_.run("INSERT INTO nodes(node, blamed) VALUES(?1, 1) ON CONFLICT DO UPDATE SET blamed = blamed + 1, done_since = 0",
                bounded(node));
}
// Only of nodes that something is held against: the others have no row.
void Ledger::count_done(const std::string& node) {
  database_.run("UPDATE nodes SET done_since = done_since + 1 WHERE node = ?1", bounded(node));
}
void Ledger::suspect(const std::string& node, const std::string& why) {
  database_.run("INSERT INTO nodes(node, suspect) VALUES(?1, ?2) ON CONFLICT DO UPDATE SET suspect = excluded.suspect", bounded(node),
                bounded(why));
}
void Ledger::trust(const std::string& node) { database_.run("DELETE FROM nodes WHERE node = ?1", bounded(node)); }

std::int64_t Ledger::add_recheck(std::int64_t job, std::string_view kind, const std::string& node, double wall_s) {
  database_.run("INSERT INTO rechecks(job, kind, state, node, made_at) VALUES(?1, ?2, 'READY', ?3, ?4)", job, kind, bounded(node), wall_s);
  return database_.last_id();
}
void Ledger::lease_recheck(std::int64_t recheck, wire::LeaseId lease, std::int64_t worker) {
  database_.run("UPDATE rechecks SET state = 'LEASED', tries = tries + 1, lease_epoch = ?2, lease_counter = ?3, worker = ?4 WHERE id = ?1",
                recheck, lease.epoch, lease.counter, worker);
}
void Ledger::end_recheck(std::int64_t recheck, std::string_view state, const std::string& message, double wall_s) {
  database_.run("UPDATE rechecks SET state = ?2, message = ?3, ended_at = ?4 WHERE id = ?1", recheck, state, bounded(message), wall_s);
}
void Ledger::reopen_recheck(std::int64_t recheck, bool counted, const std::string& message) {
  database_.run("UPDATE rechecks SET state = 'READY', tries = tries - ?2, message = ?3 WHERE id = ?1", recheck, counted ? 0 : 1,
                bounded(message));
}

}  // namespace fracfarm
