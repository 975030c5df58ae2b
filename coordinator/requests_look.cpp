// Requests that look: status, jobs, explain, records, learned, known.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/claim.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"
#include "coordinator/retry_policy.hpp"

namespace fracfarm::desk {
namespace {

constexpr int most_rows = 10000;  // of one answer

bool to_do(State state) { return !state_row(state).settled; }

nlohmann::json zero_counts() {
  nlohmann::json counts = nlohmann::json::object();
  for (const StateRow& row : state_table) counts[std::string(row.word)] = 0;
  return counts;
}

void add(nlohmann::json& counts, const std::string& name, std::uint64_t n) { counts[name] = counts.value(name, std::uint64_t{0}) + n; }

nlohmann::json class_counts(const std::vector<CountRow>& rows) {
  std::map<JobClass, nlohmann::json> classes;
  for (const CountRow& row : rows) {
    nlohmann::json& it =
        classes.try_emplace(row.job_class, nlohmann::json{{"counts", zero_counts()}, {"verdicts", nlohmann::json::object()}}).first->second;
    add(it["counts"], std::string(state_row(row.state).word), row.n);
    if (!row.verdict.empty()) add(it["verdicts"], row.verdict, row.n);
  }
  nlohmann::json list = nlohmann::json::array();
  for (auto& [job_class, it] : classes) {
    it.update({{"method", job_class.method}, {"material", job_class.material}, {"load", job_class.load}});
    list.push_back(std::move(it));
  }
  return list;
}

nlohmann::json campaigns_json(Database& ledger, const std::vector<CountRow>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const CampaignRow& row : campaign_rows(ledger)) {
    nlohmann::json counts = zero_counts();
    for (const CountRow& count : rows)
      if (count.campaign == row.id) add(counts, std::string(state_row(count.state).word), count.n);
    list.push_back({{"id", row.id},
                    {"name", row.name},
                    {"build_id", row.build_id},
                    {"total", row.total},
                    {"expanded", row.expanded},
                    {"shared", row.shared},
                    {"counts", counts}});
  }
  return list;
}

// Seconds until the last job is done: by the rate of late, else by learned times and the slots there are; nothing where neither is known.
std::optional<double> time_left(const Desk& desk, const std::vector<CountRow>& rows, std::uint64_t unmade, const Live& live) {
  std::uint64_t left = unmade;
  double work_s = 0.0;
  const std::map<JobClass, Learned> learned = learned_times(desk.ledger.reading());
  bool all_known = unmade == 0;
  for (const CountRow& row : rows) {
    if (!to_do(row.state)) continue;
    left += row.n;
    const auto known = learned.find(row.job_class);
    all_known = all_known && known != learned.end();
    if (known != learned.end()) work_s += static_cast<double>(row.n) * known->second.mean_s;
  }
  if (left == 0) return 0.0;
  if (live.rate_per_s > 0.0) return static_cast<double>(left) / live.rate_per_s;
  std::int64_t slots = 0;  // of any size: each worker names its own
  for (const LiveWorker& worker : live.workers)
    if (worker.state == "working") slots += worker.slots;
  if (!all_known || slots == 0) return std::nullopt;
  return work_s / static_cast<double>(slots);
}

nlohmann::json workers_json(const Live& live) {
  nlohmann::json list = nlohmann::json::array();
  for (const LiveWorker& it : live.workers)
    list.push_back({{"name", it.name},
                    {"node", it.node},
                    {"state", it.state},
                    {"slots", it.slots},
                    {"running", it.running},
                    {"remaining_s", it.remaining_s < 0.0 ? nlohmann::json() : nlohmann::json(it.remaining_s)},
                    {"silent_s", it.silent_s},
                    {"done", it.done},
                    {"faults", it.faults}});
  return list;
}

nlohmann::json alarms_json(Database& ledger) {
  nlohmann::json list = nlohmann::json::array();
  for (const AlarmRow& row : alarm_rows(ledger, 20))
    list.push_back({{"kind", row.kind}, {"job", row.job}, {"message", row.message}, {"raised_at", utc_text(row.raised_at)}});
  return list;
}

nlohmann::json paused_json(Database& ledger) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [it, why] : paused_classes(ledger))
    list.push_back({{"method", it.method}, {"material", it.material}, {"load", it.load}, {"why", why}});
  return list;
}

nlohmann::json suspects_json(Database& ledger) {
  nlohmann::json list = nlohmann::json::array();
  for (const NodeRow& row : node_rows(ledger))
    if (!row.suspect.empty()) list.push_back({{"node", row.node}, {"why", row.suspect}});
  return list;
}

nlohmann::json history_json(const std::vector<AttemptRow>& history) {
  nlohmann::json list = nlohmann::json::array();
  for (const AttemptRow& row : history)
    list.push_back({{"attempt", row.attempt},
                    {"fault", row.fault},
                    {"node", row.node},
                    {"worker", row.peer},
                    {"signature", row.signature},
                    {"message", row.message},
                    {"began_at", utc_text(row.began_at)},
                    {"ended_at", utc_text(row.ended_at)}});
  return list;
}

struct Explanation {
  std::string why;
  std::string todo;
};

std::string decision_on(const Desk& desk, const Job& job, std::vector<AttemptRow> history) {
  std::erase_if(history, [&](const AttemptRow& row) { return row.id <= job.forgiven; });
  if (history.empty()) return "no fault is on record";
  const auto campaign = desk.book.open(desk.ledger.reading(), job.campaign);
  return decide_retry(job, history, campaign ? (*campaign)->attempts : 1).why;
}

std::string done_text(const Job& job, const std::string& node) {
  const Outcome& out = *job.outcome;
  std::string text = fmt::format("done on {} in {} ({} steps): {}", node, duration_text(out.wall_s), out.steps, name_of(out.verdict));
  if (out.time_to_failure)
    text += fmt::format(" at {} by {}", engineering(*out.time_to_failure, "s"), out.failure_rule);
  else
    text += fmt::format(" ({})", out.failure_rule);
  if (!out.shard.empty()) text += fmt::format("; its record is in {} at byte {}, {}", out.shard, out.offset, bytes_text(out.length));
  return text;
}

// Why a READY job is not handed out: its class is paused, or no worker has the time that it may take.
Explanation explain_waiting(const Desk& desk, const Job& job) {
  Database& ledger = desk.ledger.reading();
  const std::map<JobClass, std::string> paused = paused_classes(ledger);
  if (const auto found = paused.find(job.job_class); found != paused.end())
    return {fmt::format("{} is paused: {}", text_of(job.job_class), found->second),
            "fracfarm failures --explain looks for the cause; fracfarm resume goes on"};
  const std::string why = job.attempts ? "waits for a free slot, to be tried again" : "waits for a free slot";
  if (!desk.live) return {why, "no coordinator runs: fracfarm run goes on"};
  const Live live = desk.live();
  if (live.workers.empty()) return {"no worker is here", "start one: fracfarm worker"};
  const auto campaign = desk.book.open(ledger, job.campaign);
  const LearnedTimes learned{learned_times(ledger), learned_times_by_node(ledger)};
  double most_left_s = 0.0, needs_s = 1e300;
  bool known = false;
  for (const LiveWorker& it : live.workers) {
    const LongestTry longest = longest_try(job.job_class, campaign ? (*campaign)->wall_budget_s : 0.0, learned, it.node_type);
    if (it.remaining_s < 0.0 || longest.seconds <= it.remaining_s) return {why, "nothing"};
    most_left_s = std::max(most_left_s, it.remaining_s);
    needs_s = std::min(needs_s, longest.seconds);
    known = known || longest.learned;
  }
  if (known)
    return {fmt::format("no worker has the {} left that it may take, by results of its class; the most is {}", duration_text(needs_s),
                        duration_text(most_left_s)),
            "start workers in a longer allocation"};
  return {fmt::format(
              "no worker has its whole wall-clock budget of {} left, which counts until {} results of its class are known; the most is {}",
              duration_text(needs_s), enough_history, duration_text(most_left_s)),
          "start workers in a longer allocation, or submit the campaign with a smaller wall_clock budget"};
}

Explanation explain_job(const Desk& desk, const Job& job, const std::vector<AttemptRow>& history) {
  const std::optional<WorkerRow> worker = worker_row(desk.ledger.reading(), job.worker);
  const std::string node = worker ? worker->node : "a node";
  switch (job.state) {
    case State::held:
      return {"a person held it back", fmt::format("fracfarm release {} makes it ready", job.id)};
    case State::ready:
      return explain_waiting(desk, job);
    case State::leased: {
      const std::string where = fmt::format("attempt {} is with {} on {} since {}", job.attempts, worker ? worker->peer : "a worker", node,
                                            utc_text(job.leased_at));
      return {where, desk.live ? "nothing" : "no coordinator runs: fracfarm run goes on"};
    }
    case State::done:
      return {done_text(job, node), "nothing"};
    case State::retry_wait:
      return {fmt::format("waits {} after {}", duration_text(job.wait_s), decision_on(desk, job, history)),
              fmt::format("nothing, or fracfarm retry {} at once", job.id)};
    case State::quarantined:
      return {decision_on(desk, job, history), fmt::format("replay it by hand: fracfarm explain {0} --scene > scene.json && fracfarm solve "
                                                           "scene.json -o record.h5; when the cause is mended: fracfarm retry {0}",
                                                           job.id)};
    case State::cancelled:
      return {"a person cancelled it", fmt::format("fracfarm retry {} brings it back", job.id)};
  }
  return {};
}

}  // namespace

wire::Answer status(const Desk& desk, const nlohmann::json&) {
  Database& ledger = desk.ledger.reading();
  const std::vector<CountRow> rows = count_rows(ledger);
  const Live live = desk.live ? desk.live() : Live{};
  nlohmann::json counts = zero_counts(), verdicts = nlohmann::json{{"failed", 0}, {"censored", 0}, {"rejected", 0}};
  std::uint64_t total = 0, unmade = 0;
  for (const CountRow& row : rows) {
    total += row.n;
    add(counts, std::string(state_row(row.state).word), row.n);
    if (!row.verdict.empty()) add(verdicts, row.verdict, row.n);
  }
  for (const CampaignRow& row : campaign_rows(ledger)) unmade += row.total - row.expanded;
  const std::optional<double> left = time_left(desk, rows, unmade, live);
  return answer_json({{"schema", "fracfarm.status/1"},
                      {"farm_id", meta_value(ledger, "farm_id")},
                      {"build_id", meta_value(ledger, "build_id")},
                      {"serving", static_cast<bool>(desk.live)},
                      {"epoch", live.epoch},
                      {"total", total},
                      {"unmade", unmade},
                      {"settled", is_settled(ledger)},
                      {"counts", counts},
                      {"verdicts", verdicts},
                      {"classes", class_counts(rows)},
                      {"campaigns", campaigns_json(ledger, rows)},
                      {"rate_per_s", live.rate_per_s},
                      {"eta_s", left ? nlohmann::json(*left) : nlohmann::json()},
                      {"finish_time", left ? nlohmann::json(utc_text(desk.now.wall_s + *left)) : nlohmann::json()},
                      {"faults", fault_counts(ledger)},
                      {"workers", workers_json(live)},
                      {"paused", paused_json(ledger)},
                      {"suspects", suspects_json(ledger)},
                      {"rechecks", recheck_counts(ledger)},
                      {"alarms", alarms_json(ledger)}});
}

wire::Answer jobs(const Desk& desk, const nlohmann::json& arguments) {
  JobFilter filter;
  if (const std::string state = text_of(arguments, "state"); !state.empty() && !(filter.state = state_by_name(state)))
    return answer_problems({{"state", state, "held, ready, leased, done, retry_wait, quarantined or cancelled", ""}}, "jobs");
  filter.material = text_of(arguments, "material");
  filter.load = text_of(arguments, "load");
  filter.fault = text_of(arguments, "class");
  filter.campaign = text_of(arguments, "campaign");
  filter.after = integer_of(arguments, "after").value_or(0);
  filter.limit = static_cast<int>(std::clamp<std::int64_t>(integer_of(arguments, "limit").value_or(50), 1, most_rows));
  nlohmann::json list = nlohmann::json::array();
  for (const Job& job : list_jobs(desk.ledger.reading(), desk.book, filter)) list.push_back(job_json(job));
  const bool more = list.size() == static_cast<std::size_t>(filter.limit);
  return answer_json({{"schema", "fracfarm.jobs/1"}, {"more", more}, {"jobs", std::move(list)}});
}

wire::Answer explain(const Desk& desk, const nlohmann::json& arguments) {
  const Result<Job> job = find_job(desk, text_of(arguments, "job"));
  if (!job) return answer_error(exit_bad_input, job.error().message);
  const std::vector<AttemptRow> history = attempts_of(desk.ledger.reading(), job->id);
  const Explanation said = explain_job(desk, *job, history);
  nlohmann::json body = job_json(*job);
  body.update({{"schema", "fracfarm.explain/1"}, {"why", said.why}, {"todo", said.todo}, {"history", history_json(history)}});
  if (const std::optional<WorkerRow> worker = worker_row(desk.ledger.reading(), job->worker))
    body.update({{"node", worker->node}, {"worker", worker->peer}});
  if (desk.live && job->state == State::leased)
    if (const Live live = desk.live(); live.steps.contains(job->id)) body["step"] = live.steps.at(job->id);
  if (const auto campaign = desk.book.open(desk.ledger.reading(), job->campaign)) {
    body["campaign_name"] = (*campaign)->name;
    if (flag_of(arguments, "scene")) body["scene"] = scene_text(**campaign, job->position);
  }
  return answer_json(body);
}

wire::Answer records(const Desk& desk, const nlohmann::json& arguments) {
  const int limit = static_cast<int>(std::clamp<std::int64_t>(integer_of(arguments, "limit").value_or(1000), 1, most_rows));
  nlohmann::json list = nlohmann::json::array();
  for (const Job& job : recorded_jobs(desk.ledger.reading(), integer_of(arguments, "after").value_or(0), limit)) {
    const auto campaign = desk.book.open(desk.ledger.reading(), job.campaign);
    list.push_back({{"id", job.id},
                    {"key", job.key},
                    {"store", campaign ? (*campaign)->store : "store"},
                    {"shard", job.outcome->shard},
                    {"offset", job.outcome->offset},
                    {"length", job.outcome->length},
                    {"sha256", job.outcome->sha256}});
  }
  const bool more = list.size() == static_cast<std::size_t>(limit);
  return answer_json({{"schema", "fracfarm.records/1"}, {"more", more}, {"records", std::move(list)}});
}

wire::Answer learned(const Desk& desk, const nlohmann::json&) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [job_class, it] : learned_times(desk.ledger.reading()))
    list.push_back({{"method", job_class.method},
                    {"material", job_class.material},
                    {"load", job_class.load},
                    {"n", it.n},
                    {"mean_s", it.mean_s},
                    {"p99_s", it.p99_s},
                    {"mean_bytes", it.mean_bytes}});
  return answer_json({{"schema", "fracfarm.learned/1"}, {"classes", std::move(list)}});
}

}  // namespace fracfarm::desk
