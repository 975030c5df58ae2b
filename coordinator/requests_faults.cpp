// Requests that look for causes: one worker, what failed and how, and the cases that over-representation is computed from.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm::desk {
namespace {

constexpr int most_history = 50;
constexpr int most_groups = 200;
constexpr int most_cases = 4000;  // of either kind

nlohmann::json canaries_json(Database& ledger, const std::string& node) {
  nlohmann::json list = nlohmann::json::array();
  for (const RecheckRow& row : rechecks_on(ledger, node, most_history))
    list.push_back({{"job", row.job}, {"state", row.state}, {"message", row.message}});
  return list;
}

struct Said {
  std::string why, todo;
};

Said explain_live(const LiveWorker& it, const std::string& held_against) {
  if (it.state == "stopped")
    return {
        fmt::format("{} faults within {:.0f} s of their start in a row: it gets no more jobs", most_fast_faults, fast_fault_s),
        "mend the node (fracfarm doctor there), then start the worker again; it is also let in when it does a job whose result is known"};
  if (it.state == "suspect") return {held_against, "nothing: it gets a canary, a job whose result is known, before other work"};
  if (it.state == "silent")
    return {fmt::format("nothing was heard from it for {}", duration_text(it.silent_s)),
            "look at its log in FARM/log, and whether its node is up"};
  if (it.state == "draining") return {"a person drained it: it finishes what it holds and ends", "start it again to have it back"};
  if (it.running < it.slots)
    return {fmt::format("{} of {} slots work", it.running, it.slots),
            "nothing where there is little left to do; else fracfarm explain JOB of one that waits"};
  return {"it works", "nothing"};
}

std::vector<std::pair<std::int64_t, std::uint64_t>> places(Rows rows) {
  std::vector<std::pair<std::int64_t, std::uint64_t>> list;
  while (rows.next()) list.emplace_back(rows.integer(0), static_cast<std::uint64_t>(rows.integer(1)));
  return list;
}

}  // namespace

wire::Answer worker(const Desk& desk, const nlohmann::json& arguments) {
  Database& ledger = desk.ledger.reading();
  const std::string word = text_of(arguments, "worker");
  const std::vector<WorkerRow> starts = workers_named(ledger, word, most_history);
  if (starts.empty()) {
    const std::vector<WorkerRow> all = open_workers(ledger);
    std::vector<std::string_view> names;
    for (const WorkerRow& row : all) names.push_back(row.peer);
    return answer_problems(
        {{"worker", word, names.empty() ? "there are no workers" : join(names, ", "), std::string(nearest(word, names))}}, "worker");
  }
  const std::string node = starts.front().node;
  NodeRow held;
  for (NodeRow& row : node_rows(ledger))
    if (row.node == node) held = std::move(row);
  const std::string against = held.suspect.empty() ? fmt::format("{} failures of jobs that others then did", held.blamed) : held.suspect;
  Said said{"it is not connected", "start it: fracfarm worker"};
  nlohmann::json now = nullptr;
  if (desk.live)
    for (const LiveWorker& it : desk.live().workers)
      if (it.name == word || it.node == word) {
        said = explain_live(it, against);
        now = {{"name", it.name}, {"state", it.state}, {"slots", it.slots}, {"running", it.running}, {"silent_s", it.silent_s}};
      }
  nlohmann::json history = nlohmann::json::array(), began = nlohmann::json::array();
  for (const AttemptRow& row : attempts_on(ledger, node, most_history))
    history.push_back({{"job", row.job},
                       {"fault", row.fault},
                       {"signature", row.signature},
                       {"message", row.message},
                       {"ended_at", utc_text(row.ended_at)}});
  for (const WorkerRow& row : starts)
    began.push_back({{"name", row.peer}, {"began_at", utc_text(row.began_at)}, {"done", row.done}, {"faults", row.faults}});
  return answer_json({{"schema", "fracfarm.worker/1"},
                      {"worker", word},
                      {"node", node},
                      {"node_type", starts.front().node_type},
                      {"now", std::move(now)},
                      {"why", said.why},
                      {"todo", said.todo},
                      {"blamed", held.blamed},
                      {"suspect", held.suspect.empty() ? nlohmann::json() : nlohmann::json(held.suspect)},
                      {"canaries", canaries_json(ledger, node)},
                      {"starts", std::move(began)},
                      {"history", std::move(history)}});
}

wire::Answer failures(const Desk& desk, const nlohmann::json&) {
  nlohmann::json groups = nlohmann::json::array();
  Rows rows = desk.ledger.reading().query(
      "SELECT fault, signature, method, material, load, count(*), count(DISTINCT job), count(DISTINCT node), max(job), "
      "max(attempts.ended_at)"
      " FROM attempts JOIN jobs ON jobs.id = job JOIN classes ON classes.id = class LEFT JOIN workers ON workers.id = attempts.worker"
      " WHERE fault <> 'PLANNED_STOP' GROUP BY 1, 2, 3, 4, 5 ORDER BY 6 DESC, 1, 2, 3, 4, 5 LIMIT ?1",
      most_groups);
  while (rows.next())
    groups.push_back({{"fault", rows.text(0)},
                      {"signature", rows.text(1)},
                      {"method", rows.text(2)},
                      {"material", rows.text(3)},
                      {"load", rows.text(4)},
                      {"attempts", rows.integer(5)},
                      {"jobs", rows.integer(6)},
                      {"nodes", rows.integer(7)},
                      {"example", rows.integer(8)},
                      {"last_at", utc_text(rows.real(9))}});
  return answer_json({{"schema", "fracfarm.failures/1"}, {"groups", std::move(groups)}});
}

// Jobs that failed for reasons of their own, and an even sample of those that never did; the campaigns say what they are.
wire::Answer cases(const Desk& desk, const nlohmann::json&) {
  Database& ledger = desk.ledger.reading();
  std::uint64_t done = 0;
  for (const CountRow& row : count_rows(ledger))
    if (row.state == State::done) done += row.n;
  const auto every = static_cast<std::int64_t>(std::max<std::uint64_t>(1, done / most_cases));
  const auto failed = places(ledger.query(
      "SELECT campaign, position FROM jobs WHERE id IN (SELECT DISTINCT job FROM attempts WHERE fault IN ('OUTPUT_BAD', 'SOLVER_CRASH',"
      " 'SOLVER_NUMERIC', 'OUT_OF_MEMORY', 'BAD_REQUEST') ORDER BY attempts.id DESC LIMIT ?1)",
      most_cases));
  const auto sound =
      places(ledger.query("SELECT campaign, position FROM jobs WHERE state = 'DONE' AND id * 7919 % ?1 = 0 AND NOT EXISTS(SELECT 1 FROM "
                          "attempts WHERE job = jobs.id"
                          " AND fault IN ('OUTPUT_BAD', 'SOLVER_CRASH', 'SOLVER_NUMERIC', 'OUT_OF_MEMORY', 'BAD_REQUEST')) LIMIT ?2",
                          every, 2 * most_cases));
  nlohmann::json campaigns = nlohmann::json::object();
  for (const CampaignRow& row : campaign_rows(ledger)) campaigns[std::to_string(row.id)] = row.text;
  return answer_json(
      {{"schema", "fracfarm.cases/1"}, {"every", every}, {"failed", failed}, {"sound", sound}, {"campaigns", std::move(campaigns)}});
}

}  // namespace fracfarm::desk
