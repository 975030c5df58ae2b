// Requests that change something: submit, retry, cancel, drain. Each may be asked twice with the same end.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm::desk {
namespace {

constexpr std::size_t most_listed = 1000;  // ids in an answer; the number of changes is always whole
constexpr int page = 5000;

// Jobs of another solver build than `build_id` that are not settled: two builds at work in one farm would mix their results.
std::uint64_t unfinished_of_other_builds(Database& ledger, const std::string& build_id, std::string& other) {
  std::uint64_t unfinished = 0;
  const std::vector<CountRow> counts = count_rows(ledger);
  for (const CampaignRow& campaign : campaign_rows(ledger)) {
    if (campaign.build_id == build_id) continue;
    std::uint64_t left = campaign.total - campaign.expanded;
    for (const CountRow& row : counts)
      if (row.campaign == campaign.id && !state_row(row.state).settled) left += row.n;
    if (left > 0) other = campaign.build_id;
    unfinished += left;
  }
  return unfinished;
}

struct Selection {
  std::vector<Job> named;       // by id or key
  std::vector<JobFilter> wide;  // by class, state or campaign; one for each state
  Problems problems;
};

// What retry and cancel are asked to change. `states`: those that the verb can change.
Selection select(Database& ledger, const nlohmann::json& arguments, std::span<const State> states) {
  Selection selection;
  for (const std::string& word : list_of(arguments, "jobs")) {
    if (Result<Job> job = find_job(ledger, word))
      selection.named.push_back(std::move(*job));
    else
      selection.problems.push_back({"job", word, "an id or the first characters of a key", job.error().message});
  }
  const std::string fault = text_of(arguments, "class"), state = text_of(arguments, "state"), campaign = text_of(arguments, "campaign");
  const bool wide = !fault.empty() || !state.empty() || !campaign.empty();
  if (!fault.empty() && !fault_by_name(fault))
    selection.problems.push_back({"class", fault, "a fault class as fracfarm status prints them, such as SOLVER_CRASH", ""});
  const std::optional<State> only = state_by_name(state);
  if (!state.empty() && (!only || std::find(states.begin(), states.end(), *only) == states.end())) {
    std::vector<std::string_view> words;
    for (const State it : states) words.push_back(state_row(it).name);
    selection.problems.push_back({"state", state, join(words, ", "), ""});
  }
  if (!campaign.empty()) {
    const std::vector<CampaignRow> rows = campaign_rows(ledger);
    std::vector<std::string_view> names;
    for (const CampaignRow& row : rows) names.push_back(row.name);
    if (std::find(names.begin(), names.end(), campaign) == names.end())
      selection.problems.push_back({"campaign", campaign, join(names, ", "), std::string(nearest(campaign, names))});
  }
  if (!wide && selection.named.empty() && selection.problems.empty())
    selection.problems.push_back({"jobs", "nothing", "at least one job, class, state or campaign", ""});
  if (wide)
    for (const State it : states)
      if (!only || *only == it) selection.wide.push_back({it, "", "", fault, campaign, 0, page});
  return selection;
}

struct Change {
  bool dry_run = false;
  std::uint64_t changed = 0;
  nlohmann::json ids = nlohmann::json::array();
  nlohmann::json refused = nlohmann::json::array();

  void did(const Job& job) {
    ++changed;
    if (ids.size() < most_listed) ids.push_back(job.id);
  }
  void refuse(const Job& job, const std::string& why) {
    if (refused.size() < most_listed) refused.push_back({{"job", job.id}, {"why", why}});
  }
  wire::Answer answer(std::string_view verb) const {
    const bool nothing = changed == 0 && !refused.empty();
    return answer_json(
        {{"schema", "fracfarm.change/1"}, {"verb", verb}, {"dry_run", dry_run}, {"changed", changed}, {"jobs", ids}, {"refused", refused}},
        nothing ? exit_failed : exit_ok);
  }
};

// `apply` once for each selected job, in pages by id.
template <class Apply>
void for_each_selected(Database& ledger, const Selection& selection, const Apply& apply) {
  for (const Job& job : selection.named) apply(job);
  for (JobFilter filter : selection.wide)
    for (std::vector<Job> jobs = jobs_where(ledger, filter); !jobs.empty(); jobs = jobs_where(ledger, filter)) {
      for (const Job& job : jobs) apply(job);
      filter.after = jobs.back().id;
    }
}

constexpr std::array retry_states{State::held, State::retry_wait, State::quarantined, State::cancelled};
constexpr std::array cancel_states{State::held, State::ready, State::leased, State::retry_wait, State::quarantined};

}  // namespace

wire::Answer submit(const Desk& desk, const nlohmann::json& arguments) {
  Database& ledger = desk.ledger.reading();
  const std::string text = text_of(arguments, "campaign");
  const Parsed<Campaign> campaign = parse_campaign(text, "campaign");
  if (!campaign) return answer_problems(campaign.error(), "campaign");
  std::string other;
  if (const std::uint64_t unfinished = unfinished_of_other_builds(ledger, desk.build_id, other); unfinished > 0)
    return answer_error(
        exit_bad_input,
        fmt::format(
            "this farm has {} unfinished jobs for solver build {}, this program is build {}: finish them with that build, cancel them "
            "(fracfarm cancel --state READY), or use another farm (--farm)",
            unfinished, other, desk.build_id));
  const std::int64_t id =
      desk.ledger.add_campaign(campaign->name, canonical_text(*campaign), desk.build_id, job_count(*campaign), desk.now.wall_s);
  if (meta_value(ledger, "build_id") != desk.build_id) desk.ledger.set_build_id(desk.build_id);
  const CampaignRow row = campaign_row(ledger, id).value();
  return answer_json({{"schema", "fracfarm.submit/1"},
                      {"campaign", id},
                      {"name", row.name},
                      {"total", row.total},
                      {"expanded", row.expanded},
                      {"shared", row.shared},
                      {"added", row.expanded - row.shared},
                      {"complete", row.expanded == row.total}});
}

wire::Answer retry(const Desk& desk, const nlohmann::json& arguments) {
  Database& ledger = desk.ledger.reading();
  const Selection selection = select(ledger, arguments, retry_states);
  if (!selection.problems.empty()) return answer_problems(selection.problems, "retry");
  const std::string build_id = meta_value(ledger, "build_id");
  Change change{flag_of(arguments, "dry_run")};
  for_each_selected(ledger, selection, [&](const Job& job) {
    if (std::find(retry_states.begin(), retry_states.end(), job.state) == retry_states.end())
      return change.refuse(job, fmt::format("it is {}: only a job that waits, is held, quarantined or cancelled can be tried again",
                                            state_row(job.state).word));
    if (const auto campaign = campaign_row(ledger, job.campaign); campaign && campaign->build_id != build_id)
      return change.refuse(job, fmt::format("it is for solver build {}, the farm now works with {}", campaign->build_id, build_id));
    if (!change.dry_run) desk.ledger.forgive(job.id);
    change.did(job);
  });
  return change.answer("retry");
}

wire::Answer cancel(const Desk& desk, const nlohmann::json& arguments) {
  Database& ledger = desk.ledger.reading();
  if (const auto row = next_unexpanded(ledger))
    return answer_error(exit_failed, fmt::format("campaign {} is still being made into jobs ({} of {}): ask again when it is done",
                                                 row->name, row->expanded, row->total));
  const Selection selection = select(ledger, arguments, cancel_states);
  if (!selection.problems.empty()) return answer_problems(selection.problems, "cancel");
  Change change{flag_of(arguments, "dry_run")};
  for_each_selected(ledger, selection, [&](const Job& job) {
    if (std::find(cancel_states.begin(), cancel_states.end(), job.state) == cancel_states.end())
      return change.refuse(job, fmt::format("it is {} already", state_row(job.state).word));
    if (!change.dry_run) desk.ledger.cancel(job.id);
    change.did(job);
  });
  return change.answer("cancel");
}

// No names: every worker there is.
wire::Answer drain(const Desk& desk, const nlohmann::json& arguments) {
  if (!desk.live) return answer_error(exit_unreachable, "no coordinator runs: there is no worker to drain");
  const std::vector<WorkerRow> workers = open_workers(desk.ledger.reading());
  const std::vector<std::string> wanted = list_of(arguments, "workers");
  std::vector<std::string_view> names;
  for (const WorkerRow& row : workers) names.push_back(row.peer);
  Problems problems;
  for (const std::string& word : wanted)
    if (std::none_of(workers.begin(), workers.end(), [&](const WorkerRow& row) { return row.peer == word || row.node == word; }))
      problems.push_back({"worker", word, names.empty() ? "there are no workers" : join(names, ", "), std::string(nearest(word, names))});
  if (!problems.empty()) return answer_problems(problems, "drain");
  nlohmann::json drained = nlohmann::json::array();
  const bool dry_run = flag_of(arguments, "dry_run");
  for (const WorkerRow& row : workers) {
    const bool meant = wanted.empty() || std::find(wanted.begin(), wanted.end(), row.peer) != wanted.end() ||
                       std::find(wanted.begin(), wanted.end(), row.node) != wanted.end();
    if (!meant) continue;
    if (!dry_run) desk.ledger.drain_worker(row.id);
    drained.push_back(row.peer);
  }
  return answer_json({{"schema", "fracfarm.change/1"},
                      {"verb", "drain"},
                      {"dry_run", dry_run},
                      {"changed", drained.size()},
                      {"workers", drained},
                      {"refused", nlohmann::json::array()}});
}

}  // namespace fracfarm::desk
