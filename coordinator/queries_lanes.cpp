// Campaigns' lanes: jobs that nobody has touched.
#include <fmt/format.h>

#include "coordinator/queries.hpp"

namespace fracfarm {
namespace {

#define LANE_COLUMNS                                                                                               \
  "lanes.id, campaign, campaigns.first_id, method, material, load, state, priority, next, last, stride FROM lanes" \
  " JOIN campaigns ON campaigns.id = campaign JOIN classes ON classes.id = class "

std::vector<Lane> lanes_of(Rows rows) {
  std::vector<Lane> lanes;
  while (rows.next())
    lanes.push_back({rows.integer(0),
                     rows.integer(1),
                     rows.integer(2),
                     {rows.text(3), rows.text(4), rows.text(5)},
                     state_by_name(rows.text(6)).value(),
                     static_cast<int>(rows.integer(7)),
                     rows.integer(8),
                     rows.integer(9),
                     rows.integer(10)});
  return lanes;
}

}  // namespace

std::vector<SeriesPlace> series_places(Database& ledger, const std::string& identity) {
  std::vector<SeriesPlace> list;
  Rows rows = ledger.query("SELECT campaign, block, variant FROM series WHERE identity = ?1", Blob{identity});
  while (rows.next())
    list.push_back({rows.integer(0), static_cast<std::size_t>(rows.integer(1)), static_cast<std::uint64_t>(rows.integer(2))});
  return list;
}

std::uint64_t count_done(Database& ledger, std::int64_t first, std::int64_t last, std::int64_t stride) {
  Rows rows =
      ledger.query("SELECT count(*) FROM jobs WHERE id BETWEEN ?1 AND ?2 AND (id - ?1) % ?3 = 0 AND state = 'DONE'", first, last, stride);
  rows.next();
  return static_cast<std::uint64_t>(rows.integer(0));
}

std::vector<Lane> ready_lanes(Database& ledger, int priority, std::int64_t after_next, int limit) {
  return lanes_of(ledger.query("SELECT " LANE_COLUMNS "WHERE state = 'READY' AND priority <= ?1 AND (priority < ?1 OR next > ?2)"
                               " ORDER BY priority DESC, next LIMIT ?3",
                               priority, after_next, limit));
}

// Lanes are few: those of one campaign are walked.
std::optional<Lane> lane_of(Database& ledger, std::int64_t job) {
  std::vector<Lane> lanes =
      lanes_of(ledger.query("SELECT " LANE_COLUMNS "WHERE campaign = (SELECT id FROM campaigns WHERE first_id > 0 AND first_id <= ?1"
                            " ORDER BY first_id DESC LIMIT 1) AND next <= ?1 AND last >= ?1 AND (?1 - next) % stride = 0 LIMIT 1",
                            job));
  if (lanes.empty()) return std::nullopt;
  return lanes.front();
}

std::vector<Lane> lanes_where(Database& ledger, const JobFilter& filter) {
  if (!filter.fault.empty()) return {};  // nobody has tried them
  std::string sql = "SELECT " LANE_COLUMNS "WHERE last > ?1 AND (?5 = '' OR campaigns.name = ?5)";
  if (filter.state) sql += fmt::format(" AND state = '{}'", state_row(*filter.state).name);
  if (!filter.material.empty()) sql += " AND material = ?2";
  if (!filter.load.empty()) sql += " AND load = ?3";
  if (!filter.method.empty()) sql += " AND method = ?4";
  return lanes_of(ledger.query(sql + " ORDER BY next", filter.after, filter.material, filter.load, filter.method, filter.campaign));
}

}  // namespace fracfarm
