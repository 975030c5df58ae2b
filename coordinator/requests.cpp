// The table of requests, and what they share.
#include "coordinator/requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm {
namespace {

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 7> jobs_arguments{"state", "material", "load", "class", "campaign", "after", "limit"};
constexpr std::array<std::string_view, 2> explain_arguments{"job", "scene"};
constexpr std::array<std::string_view, 1> worker_arguments{"worker"};
constexpr std::array<std::string_view, 2> page_arguments{"after", "limit"};
constexpr std::array<std::string_view, 1> campaign_arguments{"campaign"};
constexpr std::array<std::string_view, 9> mend_arguments{"jobs", "class",  "state", "campaign", "material",
                                                         "load", "method", "count", "dry_run"};
constexpr std::array<std::string_view, 10> priority_arguments{"jobs", "class",  "state", "campaign", "material",
                                                              "load", "method", "count", "dry_run",  "priority"};
constexpr std::array<std::string_view, 5> pause_arguments{"method", "material", "load", "reason", "dry_run"};
constexpr std::array<std::string_view, 3> recheck_arguments{"jobs", "repair", "dry_run"};
constexpr std::array<std::string_view, 2> drain_arguments{"workers", "dry_run"};

constexpr std::array<RequestRow, 19> table{{
    {"status", false, Names{}, desk::status, "counts, verdicts, rate, time left, faults, workers"},
    {"jobs", false, Names(jobs_arguments), desk::jobs, "jobs as rows"},
    {"explain", false, Names(explain_arguments), desk::explain, "everything that happened to one job, and what to do"},
    {"worker", false, Names(worker_arguments), desk::worker, "everything that is known of one worker, and what to do"},
    {"failures", false, Names{}, desk::failures, "how tries ended badly, by class, fault and signature"},
    {"cases", false, Names{}, desk::cases, "jobs that failed and a sample of those that did not"},
    {"records", false, Names(page_arguments), desk::records, "where the records of DONE jobs lie"},
    {"learned", false, Names{}, desk::learned, "times and sizes of results by class"},
    {"known", false, Names(campaign_arguments), desk::known, "how many jobs of this campaign are here, and how many are DONE"},
    {"submit", true, Names(campaign_arguments), desk::submit, "take a campaign"},
    {"retry", true, Names(mend_arguments), desk::retry, "READY again, with every budget anew"},
    {"release", true, Names(mend_arguments), desk::release, "READY, of those that are held"},
    {"hold", true, Names(mend_arguments), desk::hold, "not handed out until released"},
    {"priority", true, Names(priority_arguments), desk::priority, "which jobs come first"},
    {"cancel", true, Names(mend_arguments), desk::cancel, "never to be done"},
    {"drain", true, Names(drain_arguments), desk::drain, "workers finish what they hold and end"},
    {"pause", true, Names(pause_arguments), desk::pause, "nothing more of a class is handed out"},
    {"resume", true, Names(pause_arguments), desk::resume, "paused classes go on"},
    {"recheck", true, Names(recheck_arguments), desk::recheck, "compute DONE jobs again: to compare, or to have their bytes again"},
}};

Problems unknown_arguments(const RequestRow& row, const nlohmann::json& arguments) {
  Problems problems;
  for (const auto& [name, value] : arguments.items()) {
    if (std::find(row.arguments.begin(), row.arguments.end(), name) != row.arguments.end()) continue;
    const std::string_view near = nearest(name, row.arguments);
    problems.push_back({name, value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).substr(0, 100),
                        join(row.arguments, ", "), near.empty() ? std::string() : fmt::format("did you mean '{}'?", near)});
  }
  return problems;
}

}  // namespace

std::span<const RequestRow> requests() { return table; }

wire::Answer answer_ask(const Desk& desk, const wire::Ask& ask) {
  const auto* const row = std::find_if(table.begin(), table.end(), [&](const RequestRow& it) { return it.verb == ask.verb; });
  if (row == table.end()) return desk::answer_error(exit_bad_input, fmt::format("there is no request '{:.40}'", ask.verb));
  const nlohmann::json arguments = nlohmann::json::parse(ask.arguments.empty() ? "{}" : ask.arguments, nullptr, false);
  if (!arguments.is_object())
    return desk::answer_error(exit_bad_input, fmt::format("the arguments of '{}' are not a JSON object", row->verb));
  if (const Problems problems = unknown_arguments(*row, arguments); !problems.empty()) return desk::answer_problems(problems, ask.verb);
  return row->answer(desk, arguments);
}

bool is_settled(Database& ledger) {
  Rows rows = ledger.query(
      "SELECT EXISTS(SELECT 1 FROM counts WHERE n > 0 AND state IN ('READY', 'LEASED', 'RETRY_WAIT')) OR EXISTS(SELECT 1 FROM campaigns"
      " WHERE expanded < total) OR EXISTS(SELECT 1 FROM rechecks WHERE state IN ('READY', 'LEASED') AND kind <> 'CANARY')");
  return rows.next() && rows.integer(0) == 0;
}

namespace desk {

wire::Answer answer_json(const nlohmann::json& body, int exit_code) {
  return {exit_code, body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

wire::Answer answer_error(int exit_code, const std::string& message) {
  return answer_json({{"schema", "fracfarm.error/1"}, {"fault", fault_row(Fault::bad_request).name}, {"message", message}}, exit_code);
}

wire::Answer answer_problems(const Problems& problems, const std::string& what) {
  nlohmann::json list = nlohmann::json::array();
  for (const Problem& p : problems) list.push_back({{"key", p.key}, {"value", p.value}, {"limit", p.limit}, {"suggestion", p.suggestion}});
  return answer_json({{"schema", "fracfarm.problems/1"}, {"what", what}, {"problems", list}}, exit_bad_input);
}

std::string text_of(const nlohmann::json& arguments, const char* name) {
  const auto found = arguments.find(name);
  if (found == arguments.end()) return {};
  if (found->is_number_integer()) return std::to_string(found->get<std::int64_t>());
  return found->is_string() ? found->get<std::string>() : std::string();
}

bool flag_of(const nlohmann::json& arguments, const char* name) {
  const auto found = arguments.find(name);
  return found != arguments.end() && found->is_boolean() && found->get<bool>();
}

std::optional<std::int64_t> integer_of(const nlohmann::json& arguments, const char* name) {
  const auto found = arguments.find(name);
  if (found == arguments.end() || !found->is_number_integer()) return std::nullopt;
  return found->get<std::int64_t>();
}

std::vector<std::string> list_of(const nlohmann::json& arguments, const char* name) {
  std::vector<std::string> words;
  const auto found = arguments.find(name);
  if (found == arguments.end() || !found->is_array()) return words;
  for (const nlohmann::json& word : *found) {
    if (word.is_string()) words.push_back(word.get<std::string>());
    if (word.is_number_integer()) words.push_back(std::to_string(word.get<std::int64_t>()));
  }
  return words;
}

nlohmann::json job_json(const Job& job) {
  nlohmann::json it{{"id", job.id},
                    {"key", job.key},
                    {"campaign", job.campaign},
                    {"method", job.job_class.method},
                    {"material", job.job_class.material},
                    {"load", job.job_class.load},
                    {"crack_set", job.crack_set},
                    {"sample_id", job.sample_id},
                    {"pattern", fmt::format("{} {}", job.crack_set, job.sample_id)},
                    {"state", state_row(job.state).word},
                    {"attempts", job.attempts},
                    {"step_scale", job.step_scale},
                    {"verdict", nullptr},
                    {"time_to_failure", nullptr}};
  if (!job.outcome) return it;
  const Outcome& out = *job.outcome;
  it["verdict"] = name_of(out.verdict);
  if (out.time_to_failure) it["time_to_failure"] = *out.time_to_failure;
  it.update({{"failure_rule", out.failure_rule},
             {"peak_stress", out.peak_stress},
             {"steps", out.steps},
             {"cpu_s", out.cpu_s},
             {"wall_s", out.wall_s},
             {"shard", out.shard},
             {"offset", out.offset},
             {"length", out.length},
             {"sha256", out.shard.empty() ? std::string() : out.sha256}});
  return it;
}

Result<Job> find_job(const Desk& desk, const std::string& word) {
  Database& ledger = desk.ledger.reading();
  const bool number =
      !word.empty() && word.size() <= 12 && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (number) {
    if (std::optional<Job> job = look_up(ledger, desk.book, std::stoll(word))) return *job;
    if (word.size() < 4) return fail(Fault::bad_request, fmt::format("there is no job {}", word));
  }
  const bool hex = std::all_of(word.begin(), word.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  if (!hex || word.size() < 4 || word.size() > 64)
    return fail(Fault::bad_request, fmt::format("'{:.70}' is neither a job's id nor 4 to 64 characters of its key", word));
  std::vector<Job> found = jobs_by_key_prefix(ledger, word, 2);
  if (found.empty())
    return fail(Fault::bad_request, fmt::format("no job's key begins with {}; one that nobody has tried yet is found by its id", word));
  if (found.size() > 1)
    return fail(Fault::bad_request,
                fmt::format("more than one job's key begins with {}: {:.16} and {:.16}", word, found[0].key, found[1].key));
  return found[0];
}

}  // namespace desk
}  // namespace fracfarm
