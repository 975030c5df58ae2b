// Verbs on campaign files: plan (what would be run), submit (put the jobs into the ledger).
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/submission.hpp"
#include "coordinator/enrolment.hpp"
#include "coordinator/job.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

// Where nothing of a class has been measured in the farm: an orthogonal sample on the default grid, rounded up.
constexpr double default_job_s = 1.0;
constexpr double default_record_bytes = 0.75e6;

struct PlanRow {
  std::string material, load, set, method;
  auto operator<=>(const PlanRow&) const = default;
};

// Jobs by class and crack set: counted by series and ranges of patterns, not one by one.
std::map<PlanRow, std::uint64_t> count_jobs(const Campaign& campaign) {
  std::map<PlanRow, std::uint64_t> counts;
  for (const Series& series : series_of(campaign))
    for (const IdRange& range : campaign.blocks[series.block].patterns)
      counts[{series.first.material, series.first.load, std::string(name_of(range.set)), std::string(name_of(series.first.method))}] +=
          range.last - range.first + 1;
  return counts;
}

// How much of the campaign the farm has already, overlapping campaigns included.
Result<Known> ask_known(FarmLink& link, const Campaign& campaign) {
  const Result<wire::Answer> answer = link.ask("known", {{"campaign", canonical_text(campaign)}});
  if (!answer) return tl::unexpected(answer.error());
  const json body = json::parse(answer->body);
  return Known{body.value("present", std::uint64_t{0}), body.value("done", std::uint64_t{0})};
}

struct Estimates {
  Known known;
  std::map<JobClass, std::pair<double, double>> learned;  // seconds, bytes of a job
};

// Nothing is known where there is no farm yet: a plan needs none.
Result<Estimates> ask_farm(const std::filesystem::path& farm, const Campaign& campaign) {
  Estimates estimates;
  std::error_code none;
  if (!std::filesystem::exists(FarmPaths{farm}.ledger(), none) && !std::filesystem::exists(FarmPaths{farm}.endpoint(), none))
    return estimates;
  Result<FarmLink> link = FarmLink::open(farm);
  if (!link) return tl::unexpected(link.error());
  const Result<wire::Answer> learned = link->ask("learned", json::object());
  if (!learned) return tl::unexpected(learned.error());
  const json body = json::parse(learned->body);
  for (const json& it : body["classes"])
    estimates.learned[{it.value("method", ""), it.value("material", ""), it.value("load", "")}] = {it.value("mean_s", 0.0),
                                                                                                   it.value("mean_bytes", 0.0)};
  const Result<Known> known = ask_known(*link, campaign);
  if (!known) return tl::unexpected(known.error());
  estimates.known = *known;
  return estimates;
}

json plan_json(const Campaign& campaign, const Estimates& estimates) {
  json classes = json::array();
  double seconds = 0.0, bytes = 0.0;
  for (const auto& [row, n] : count_jobs(campaign)) {
    const auto known = estimates.learned.find({row.method, row.material, row.load});
    const bool measured = known != estimates.learned.end();
    const double job_s = measured ? known->second.first : default_job_s, record = measured ? known->second.second : default_record_bytes;
    seconds += static_cast<double>(n) * job_s;
    bytes += static_cast<double>(n) * record;
    classes.push_back({{"method", row.method},
                       {"material", row.material},
                       {"load", row.load},
                       {"crack_set", row.set},
                       {"jobs", n},
                       {"job_s", job_s},
                       {"record_bytes", record},
                       {"measured", measured}});
  }
  const std::uint64_t total = job_count(campaign);
  const double left = total ? static_cast<double>(total - estimates.known.done) / static_cast<double>(total) : 0.0;
  return {{"schema", "fracfarm.plan/1"},
          {"name", campaign.name},
          {"jobs", total},
          {"present", estimates.known.present},
          {"done", estimates.known.done},
          {"core_hours", seconds * left / 3600.0},
          {"bytes", bytes * left},
          {"wall_budget_s", campaign.wall_budget_s},
          {"attempts", campaign.attempts},
          {"store", campaign.store},
          {"classes", classes}};
}

std::string plan_text(const json& plan) {
  std::vector<std::vector<std::string>> rows{{"material", "load", "cracks", "method", "jobs", "each", "record"}};
  bool measured = true;
  for (const json& it : plan["classes"]) {
    measured = measured && it.value("measured", false);
    const std::string mark = it.value("measured", false) ? "" : " *";
    rows.push_back({it.value("material", ""), it.value("load", ""), it.value("crack_set", ""), it.value("method", ""),
                    std::to_string(it.value("jobs", std::uint64_t{0})), duration_text(it.value("job_s", 0.0)) + mark,
                    bytes_text(static_cast<std::uint64_t>(it.value("record_bytes", 0.0))) + mark});
  }
  std::string text = fmt::format("campaign {}: {} jobs, {} in this farm already, {} of them done\n\n{}\n", plan.value("name", ""),
                                 plan.value("jobs", std::uint64_t{0}), plan.value("present", std::uint64_t{0}),
                                 plan.value("done", std::uint64_t{0}), table_text(rows));
  text += fmt::format("left: {:.3g} core hours, {} of records; a job may take {} at most and fail {} times\n",
                      plan.value("core_hours", 0.0), bytes_text(static_cast<std::uint64_t>(plan.value("bytes", 0.0))),
                      duration_text(plan.value("wall_budget_s", 0.0)), plan.value("attempts", 0));
  return measured ? text : text + "* assumed: nothing of this class has been measured in this farm\n";
}

}  // namespace

int run_plan(int argc, char** argv) {
  FarmOptions options;
  std::filesystem::path file;
  Command app{"What a campaign would run: jobs by class, what is done already, core hours and disk. Changes nothing.", "fracfarm plan"};
  app.add_option("CAMPAIGN", file, "campaign file, TOML or JSON").required();
  add_farm_options(app, options);
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] {
    const Parsed<Campaign> campaign = load_campaign(file);
    if (!campaign) return report_problems(campaign.error(), file.string(), options.json);
    const Result<Estimates> estimates = ask_farm(options.farm, *campaign);
    if (!estimates) return report_unreachable(estimates.error(), options.json);
    const json plan = plan_json(*campaign, *estimates);
    fmt::print("{}", options.json ? plan.dump(2) + "\n" : plan_text(plan));
    return static_cast<int>(exit_ok);
  });
}

int run_submit(int argc, char** argv) {
  FarmOptions options;
  std::filesystem::path file;
  Command app{"Puts the jobs of a campaign into the ledger; submitting again changes nothing. fracfarm run also does the work.",
              "fracfarm submit"};
  app.add_option("CAMPAIGN", file, "campaign file, TOML or JSON").required();
  add_farm_options(app, options);
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] {
    const Parsed<Campaign> campaign = load_campaign(file);
    if (!campaign) return report_problems(campaign.error(), file.string(), options.json);
    Result<FarmLink> link = FarmLink::open(options.farm, true);
    if (!link) return report_unreachable(link.error(), options.json);
    const Answered answer = submit(*link, *campaign, options.json);
    if (answer.usable) fmt::print("{}", options.json ? json::parse(answer.body).dump(2) + "\n" : submitted_text(json::parse(answer.body)));
    return answer.exit_code;
  });
}

}  // namespace fracfarm::cli
