// The ledger's writing of jobs that nobody has touched, and how they become rows.
#include "coordinator/ledger.hpp"

namespace fracfarm {
namespace {

constexpr std::string_view insert_job =
    "INSERT INTO jobs(id, key, campaign, position, class, oblique, sample_id, state, priority, attempts, lease_epoch, lease_counter, "
    "worker,"
    " leased_at) VALUES(nullif(?1, 0), ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14) ON CONFLICT DO NOTHING";

}  // namespace

std::int64_t Ledger::class_id(const JobClass& job_class) {
  if (const auto found = classes_.find(job_class); found != classes_.end()) return found->second;
  database_.run("INSERT INTO classes(method, material, load) VALUES(?1, ?2, ?3) ON CONFLICT DO NOTHING", job_class.method,
                job_class.material, job_class.load);
  Rows rows = database_.query("SELECT id FROM classes WHERE method = ?1 AND material = ?2 AND load = ?3", job_class.method,
                              job_class.material, job_class.load);
  rows.next();
  return classes_[job_class] = rows.integer(0);
}

// Ids follow one another over the campaigns; where two share a job, the later one's id of it is never used.
std::int64_t Ledger::place_campaign(std::int64_t campaign) {
  std::int64_t first = 0;
  {
    Rows rows = database_.query(
        "SELECT 1 + max((SELECT coalesce(max(id), 0) FROM jobs),"
        " (SELECT coalesce(max(first_id + total - 1), 0) FROM campaigns WHERE first_id > 0))");
    rows.next();
    first = rows.integer(0);
  }
  database_.run("UPDATE campaigns SET first_id = ?2 WHERE id = ?1", campaign, first);
  return first;
}

void Ledger::add_series(const std::string& identity, const SeriesPlace& place) {
  database_.run("INSERT INTO series VALUES(?1, ?2, ?3, ?4) ON CONFLICT DO NOTHING", Blob{identity}, place.campaign, place.block,
                place.variant);
}

void Ledger::add_lane(const Lane& lane) {
  database_.run("INSERT INTO lanes(campaign, class, state, priority, next, last, stride) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7)", lane.campaign,
                class_id(lane.job_class), state_row(lane.state).name, lane.priority, lane.next, lane.last, lane.stride);
}

void Ledger::advance_lane(const Lane& lane, std::int64_t next) {
  if (next > lane.last)
    database_.run("DELETE FROM lanes WHERE id = ?1", lane.id);
  else
    database_.run("UPDATE lanes SET next = ?2 WHERE id = ?1", lane.id, next);
}

void Ledger::take_from_lane(const Lane& lane, std::int64_t job) {
  if (job == lane.next) return advance_lane(lane, job + lane.stride);
  database_.run("UPDATE lanes SET last = ?2 WHERE id = ?1", lane.id, job - lane.stride);
  if (job == lane.last) return;
  Lane rest = lane;
  rest.next = job + lane.stride;
  add_lane(rest);
}

Lane Ledger::split_lane(const Lane& lane, std::uint64_t n) {
  if (n >= lane.size()) return lane;
  Lane front = lane;
  front.last = lane.next + static_cast<std::int64_t>(n - 1) * lane.stride;
  advance_lane(lane, front.last + lane.stride);
  add_lane(front);
  front.id = database_.last_id();
  return front;
}

void Ledger::set_lane(std::int64_t lane, State state, int priority) {
  database_.run("UPDATE lanes SET state = ?2, priority = ?3 WHERE id = ?1", lane, state_row(state).name, priority);
}

bool Ledger::add_job(const NewJob& job) {
  const std::string key = bytes_of_hex(job.key);
  return database_.run(insert_job, job.id, Blob{key}, job.campaign, job.position, class_id(job.job_class), job.crack_set == "oblique",
                       job.sample_id, state_row(job.state).name, job.priority, 0, std::nullopt, std::nullopt, std::nullopt,
                       std::nullopt) == 1;
}

bool Ledger::add_leased(const NewJob& job, wire::LeaseId lease, std::int64_t worker, double wall_s) {
  const std::string key = bytes_of_hex(job.key);
  return database_.run(insert_job, job.id, Blob{key}, job.campaign, job.position, class_id(job.job_class), job.crack_set == "oblique",
                       job.sample_id, state_row(State::leased).name, job.priority, 1, lease.epoch, lease.counter, worker, wall_s) == 1;
}

void Ledger::count_shared(std::int64_t campaign) { database_.run("UPDATE campaigns SET shared = shared + 1 WHERE id = ?1", campaign); }

}  // namespace fracfarm
