// Requests about workers, classes and results: drain, pause, resume, recheck.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/text.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/requests_parts.hpp"

namespace fracfarm::desk {
namespace {

wire::Answer changed(std::string_view verb, bool dry_run, nlohmann::json what, const char* name, nlohmann::json refused) {
  const bool nothing = what.empty() && !refused.empty();
  return answer_json({{"schema", "fracfarm.change/1"},
                      {"verb", verb},
                      {"dry_run", dry_run},
                      {"changed", what.size()},
                      {name, std::move(what)},
                      {"refused", std::move(refused)}},
                     nothing ? exit_failed : exit_ok);
}

// Classes of the farm that the arguments mean; without any, all of them.
std::vector<JobClass> classes_meant(Database& ledger, const nlohmann::json& arguments) {
  const std::string method = text_of(arguments, "method"), material = text_of(arguments, "material"), load = text_of(arguments, "load");
  std::vector<JobClass> meant;
  for (const JobClass& it : all_classes(ledger))
    if ((method.empty() || it.method == method) && (material.empty() || it.material == material) && (load.empty() || it.load == load))
      meant.push_back(it);
  return meant;
}

wire::Answer no_class(Database& ledger, std::string_view verb) {
  std::vector<std::string> names;
  for (const JobClass& it : all_classes(ledger)) names.push_back(text_of(it));
  const std::vector<std::string_view> views(names.begin(), names.end());
  return answer_problems({{"class", "none", views.empty() ? "the farm has no jobs yet" : join(views, ", "), ""}}, std::string(verb));
}

}  // namespace

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

// Nothing more of these classes is handed out; what runs goes on.
wire::Answer pause(const Desk& desk, const nlohmann::json& arguments) {
  const std::vector<JobClass> meant = classes_meant(desk.ledger.reading(), arguments);
  if (meant.empty()) return no_class(desk.ledger.reading(), "pause");
  const std::string said = text_of(arguments, "reason"), why = said.empty() ? "a person paused it" : said;
  const bool dry_run = flag_of(arguments, "dry_run");
  nlohmann::json paused = nlohmann::json::array();
  for (const JobClass& it : meant) {
    if (!dry_run) desk.ledger.pause_class(it, why, desk.now.wall_s);
    paused.push_back(text_of(it));
  }
  return changed("pause", dry_run, std::move(paused), "classes", nlohmann::json::array());
}

wire::Answer resume(const Desk& desk, const nlohmann::json& arguments) {
  const std::vector<JobClass> meant = classes_meant(desk.ledger.reading(), arguments);
  if (meant.empty()) return no_class(desk.ledger.reading(), "resume");
  const bool dry_run = flag_of(arguments, "dry_run");
  const std::map<JobClass, std::string> paused = paused_classes(desk.ledger.reading());
  nlohmann::json resumed = nlohmann::json::array();
  for (const JobClass& it : meant) {
    if (!paused.contains(it)) continue;
    if (!dry_run) desk.ledger.resume_class(it);
    resumed.push_back(text_of(it));
  }
  return changed("resume", dry_run, std::move(resumed), "classes", nlohmann::json::array());
}

// DONE jobs are computed again: to compare (an audit), or with `repair` to have bytes again where those in the store are damaged.
wire::Answer recheck(const Desk& desk, const nlohmann::json& arguments) {
  Problems problems;
  std::vector<Job> jobs;
  for (const std::string& word : list_of(arguments, "jobs")) {
    if (Result<Job> job = find_job(desk, word))
      jobs.push_back(std::move(*job));
    else
      problems.push_back({"job", word, "an id or the first characters of a key", job.error().message});
  }
  if (jobs.empty() && problems.empty()) problems.push_back({"jobs", "nothing", "at least one job that is done", ""});
  if (!problems.empty()) return answer_problems(problems, "recheck");
  const bool dry_run = flag_of(arguments, "dry_run"), repair = flag_of(arguments, "repair");
  nlohmann::json again = nlohmann::json::array(), refused = nlohmann::json::array();
  for (const Job& job : jobs) {
    const auto campaign = campaign_row(desk.ledger.reading(), job.campaign);
    const std::vector<RecheckRow> earlier = rechecks_of(desk.ledger.reading(), job.id);
    const bool open =
        std::any_of(earlier.begin(), earlier.end(), [](const RecheckRow& it) { return it.state == "READY" || it.state == "LEASED"; });
    const std::string why = job.state != State::done                     ? fmt::format("it is {}, not done", state_row(job.state).word)
                            : open                                       ? "it is being computed again already"
                            : !job.outcome || job.outcome->shard.empty() ? "it has no record"
                            : campaign->build_id != desk.build_id
                                ? fmt::format("it is of solver build {}, this program is {}", campaign->build_id, desk.build_id)
                                : "";
    if (!why.empty()) {
      refused.push_back({{"job", job.id}, {"why", why}});
      continue;
    }
    const std::optional<WorkerRow> worker = worker_row(desk.ledger.reading(), job.worker);
    if (!dry_run) desk.ledger.add_recheck(job.id, repair ? "REPAIR" : "AUDIT", worker ? worker->node : "", desk.now.wall_s);
    again.push_back(job.id);
  }
  return changed("recheck", dry_run, std::move(again), "jobs", std::move(refused));
}

}  // namespace fracfarm::desk
