// Requests that move jobs: retry, release, hold, cancel, priority. Each may be asked twice with the same end, and says with dry_run what it
// would do.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm::desk {
namespace {

constexpr std::size_t most_listed = 1000;  // ids in an answer; the number of changes is always whole
constexpr int page = 5000;

// A verb that moves jobs: from which states, and how.
struct Move {
  std::string_view verb;
  std::span<const State> from;
  State lane_to;          // what becomes of jobs that nobody has touched; READY ones stay where a priority changes
  std::string_view only;  // said of a job in another state
};

struct Selection {
  std::vector<Job> named;       // by id or key
  std::vector<JobFilter> wide;  // by class, state or campaign; one for each state
  std::uint64_t most = UINT64_MAX;
  Problems problems;
};

void demand_campaign(Database& ledger, const std::string& campaign, Problems& problems) {
  const std::vector<CampaignRow> rows = campaign_rows(ledger);
  std::vector<std::string_view> names;
  for (const CampaignRow& row : rows) names.push_back(row.name);
  if (std::find(names.begin(), names.end(), campaign) == names.end())
    problems.push_back({"campaign", campaign, join(names, ", "), std::string(nearest(campaign, names))});
}

Selection select(const Desk& desk, const nlohmann::json& arguments, std::span<const State> states) {
  Selection selection;
  for (const std::string& word : list_of(arguments, "jobs")) {
    if (Result<Job> job = find_job(desk, word))
      selection.named.push_back(std::move(*job));
    else
      selection.problems.push_back({"job", word, "an id or the first characters of a key", job.error().message});
  }
  JobFilter filter;
  filter.fault = text_of(arguments, "class");
  filter.campaign = text_of(arguments, "campaign");
  filter.material = text_of(arguments, "material");
  filter.load = text_of(arguments, "load");
  filter.method = text_of(arguments, "method");
  filter.limit = page;
  const std::string state = text_of(arguments, "state");
  const bool wide = !(filter.fault + filter.campaign + filter.material + filter.load + filter.method + state).empty();
  if (!filter.fault.empty() && !fault_by_name(filter.fault))
    selection.problems.push_back({"class", filter.fault, "a fault class as fracfarm status prints them, such as SOLVER_CRASH", ""});
  const std::optional<State> only = state_by_name(state);
  if (!state.empty() && (!only || std::find(states.begin(), states.end(), *only) == states.end())) {
    std::vector<std::string_view> words;
    for (const State it : states) words.push_back(state_row(it).name);
    selection.problems.push_back({"state", state, join(words, ", "), ""});
  }
  if (!filter.campaign.empty()) demand_campaign(desk.ledger.reading(), filter.campaign, selection.problems);
  if (const auto count = integer_of(arguments, "count")) {
    if (*count < 1) selection.problems.push_back({"count", std::to_string(*count), "1 or more", ""});
    selection.most = static_cast<std::uint64_t>(std::max<std::int64_t>(1, *count));
  }
  if (!wide && selection.named.empty() && selection.problems.empty())
    selection.problems.push_back({"jobs", "nothing", "at least one job, class, state, campaign, material, load or method", ""});
  if (wide)
    for (const State it : states)
      if (!only || *only == it) {
        filter.state = it;
        selection.wide.push_back(filter);
      }
  return selection;
}

struct Change {
  bool dry_run = false;
  std::uint64_t left = UINT64_MAX;
  std::uint64_t changed = 0;
  nlohmann::json ids = nlohmann::json::array();
  nlohmann::json refused = nlohmann::json::array();

  void did(std::int64_t id) {
    ++changed, --left;
    if (ids.size() < most_listed) ids.push_back(id);
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

bool is_from(const Move& move, State state) { return std::find(move.from.begin(), move.from.end(), state) != move.from.end(); }

// Jobs that nobody has touched move by the lane.
void move_lanes(const Desk& desk, const Move& move, const JobFilter& filter, int priority, Change& change) {
  for (Lane lane : lanes_where(desk.ledger.reading(), filter)) {
    if (change.left == 0) return;
    if (!change.dry_run && lane.size() > change.left) lane = desk.ledger.split_lane(lane, change.left);
    const std::uint64_t n = std::min(lane.size(), change.left);
    const bool same_state = move.verb == "priority";
    if (!change.dry_run) desk.ledger.set_lane(lane.id, same_state ? lane.state : move.lane_to, same_state ? priority : lane.priority);
    for (std::uint64_t at = 0; at < n && change.ids.size() < most_listed; ++at)
      change.ids.push_back(lane.next + static_cast<std::int64_t>(at) * lane.stride);
    change.changed += n;
    change.left -= n;
  }
}

// `apply` to each selected job, in pages by id.
template <class Apply>
wire::Answer move_jobs(const Desk& desk, const nlohmann::json& arguments, const Move& move, const Apply& apply, int priority = 0) {
  const Selection selection = select(desk, arguments, move.from);
  if (!selection.problems.empty()) return answer_problems(selection.problems, std::string(move.verb));
  Change change{flag_of(arguments, "dry_run"), selection.most};
  const auto one = [&](const Job& job) {
    if (change.left == 0) return;
    if (!is_from(move, job.state)) return change.refuse(job, fmt::format("it is {}: only {}", state_row(job.state).word, move.only));
    if (std::string why = apply(job, change.dry_run); !why.empty()) return change.refuse(job, why);
    change.did(job.id);
  };
  for (const Job& job : selection.named) one(job);
  for (JobFilter filter : selection.wide) {
    for (std::vector<Job> jobs = jobs_where(desk.ledger.reading(), filter); !jobs.empty();
         jobs = jobs_where(desk.ledger.reading(), filter)) {
      for (const Job& job : jobs) one(job);
      filter.after = jobs.back().id;
    }
    filter.after = 0;
    move_lanes(desk, move, filter, priority, change);
  }
  return change.answer(move.verb);
}

constexpr std::array retry_states{State::held, State::retry_wait, State::quarantined, State::cancelled};
constexpr std::array release_states{State::held};
constexpr std::array hold_states{State::ready, State::retry_wait};
constexpr std::array cancel_states{State::held, State::ready, State::leased, State::retry_wait, State::quarantined};
constexpr std::array priority_states{State::held, State::ready, State::leased, State::retry_wait, State::quarantined};
constexpr Move retry_move{"retry", retry_states, State::ready, "a job that waits, is held, quarantined or cancelled can be tried again"};
constexpr Move release_move{"release", release_states, State::ready, "a job that is held can be released"};
constexpr Move hold_move{"hold", hold_states, State::held, "a job that waits can be held"};
constexpr Move cancel_move{"cancel", cancel_states, State::cancelled, "a job that is not settled can be cancelled"};
constexpr Move priority_move{"priority", priority_states, State::ready, "a job that is still to be done has a priority"};

// The job has a row from now on. It is there: it was selected a moment ago.
std::int64_t touched(const Desk& desk, const Job& job) {
  const std::optional<Job> row = touch(desk.ledger, desk.book, job.id);
  return row ? row->id : 0;
}

// Why a job of another build cannot be made ready, or empty.
std::string of_another_build(const Desk& desk, const Job& job) {
  const std::string build_id = meta_value(desk.ledger.reading(), "build_id");
  const auto campaign = campaign_row(desk.ledger.reading(), job.campaign);
  if (!campaign || campaign->build_id == build_id) return {};
  return fmt::format("it is for solver build {}, the farm now works with {}", campaign->build_id, build_id);
}

}  // namespace

wire::Answer retry(const Desk& desk, const nlohmann::json& arguments) {
  return move_jobs(desk, arguments, retry_move, [&](const Job& job, bool dry_run) {
    if (std::string why = of_another_build(desk, job); !why.empty()) return why;
    if (!dry_run) desk.ledger.forgive(touched(desk, job));
    return std::string();
  });
}

wire::Answer release(const Desk& desk, const nlohmann::json& arguments) {
  return move_jobs(desk, arguments, release_move, [&](const Job& job, bool dry_run) {
    if (std::string why = of_another_build(desk, job); !why.empty()) return why;
    if (!dry_run) desk.ledger.make_ready(touched(desk, job));
    return std::string();
  });
}

wire::Answer hold(const Desk& desk, const nlohmann::json& arguments) {
  return move_jobs(desk, arguments, hold_move, [&](const Job& job, bool dry_run) {
    if (!dry_run) desk.ledger.hold(touched(desk, job));
    return std::string();
  });
}

wire::Answer cancel(const Desk& desk, const nlohmann::json& arguments) {
  return move_jobs(desk, arguments, cancel_move, [&](const Job& job, bool dry_run) {
    if (!dry_run) desk.ledger.cancel(touched(desk, job));
    return std::string();
  });
}

wire::Answer priority(const Desk& desk, const nlohmann::json& arguments) {
  const auto asked = integer_of(arguments, "priority");
  if (!asked || *asked < -1000 || *asked > 1000)
    return answer_problems(
        {{"priority", text_of(arguments, "priority"), "a whole number from -1000 to 1000; 0 is usual, higher is sooner", ""}}, "priority");
  const int value = static_cast<int>(*asked);
  return move_jobs(
      desk, arguments, priority_move,
      [&](const Job& job, bool dry_run) {
        if (!dry_run) desk.ledger.prioritize(touched(desk, job), value);
        return std::string();
      },
      value);
}

}  // namespace fracfarm::desk
