// The verb `report`: gathers jobs and a few records of a farm and writes the page of coordinator/report.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/picture/record_picture.hpp"
#include "common/record/reader.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/record_places.hpp"
#include "coordinator/report.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

constexpr int picture_pixels = 192;
constexpr std::size_t curve_points = 160;

ReportRun run_of(const json& job) {
  ReportRun run;
  run.job = job.at("id").get<std::uint64_t>();
  run.material = job.at("material").get<std::string>();
  run.load = job.at("load").get<std::string>();
  run.pattern = job.at("pattern").get<std::string>();
  run.verdict = verdict_by_name(job.at("verdict").get<std::string>()).value_or(Verdict::censored);
  if (job.at("time_to_failure").is_number()) run.time_to_failure = job.at("time_to_failure").get<double>();
  run.rule = job.value("failure_rule", "");
  run.peak_stress = job.value("peak_stress", 0.0);
  run.steps = job.value("steps", 0LL);
  run.cpu_s = job.value("cpu_s", 0.0);
  return run;
}

// Jobs that are drawn: those of the first patterns of each load, so that a row of the grid shows every material.
std::set<std::uint64_t> jobs_to_draw(const std::vector<ReportRun>& runs) {
  std::map<std::string, std::set<std::string>> patterns;  // by load
  std::set<std::uint64_t> jobs;
  for (const ReportRun& run : runs) {
    std::set<std::string>& known = patterns[run.load];
    if (!known.contains(run.pattern) && known.size() >= report_max_patterns) continue;
    known.insert(run.pattern);
    jobs.insert(run.job);
  }
  return jobs;
}

ReportPicture picture_of(const Record& record) {
  const bool on_mesh = record.method == "fdem";
  const auto png = [&](const std::vector<float>& damage) {
    return picture::png_bytes(picture::draw_damage(record, damage, picture_pixels));
  };
  ReportPicture drawn{png(on_mesh ? record.fdem.damage_initial : record.phase_field.psi_initial),
                      png(on_mesh ? record.fdem.damage_failure : record.phase_field.psi_failure),
                      {}};
  const auto time = record.series["step_time"], stress = record.series["stress_zz"];
  const std::size_t stride = std::max<std::size_t>(1, time.size() / curve_points);
  for (std::size_t i = 0; i < time.size(); i += stride) drawn.stress.emplace_back(time[i], stress[i]);
  return drawn;
}

// Every DONE job in pages; runs beyond the page's limit are only counted.
Result<void> gather_runs(FarmLink& link, ReportPage& page) {
  for (std::int64_t after = 0;;) {
    const Result<wire::Answer> answer = link.ask("jobs", {{"state", "done"}, {"after", after}, {"limit", 1000}});
    if (!answer) return tl::unexpected(answer.error());
    const json body = json::parse(answer->body);
    for (const json& job : body.at("jobs")) {
      after = job.at("id").get<std::int64_t>();
      if (page.runs.size() < report_max_runs)
        page.runs.push_back(run_of(job));
      else
        ++page.runs_left_out;
    }
    if (!body.at("more").get<bool>()) return {};
  }
}

void draw_pictures(const std::vector<RecordPlace>& places, ReportPage& page) {
  ProgressLine progress;
  std::size_t done = 0;
  for (const RecordPlace& place : places) {
    if (++done > 20) progress.show(fmt::format("pictures {}/{}", done, places.size()));
    const Result<std::string> bytes = read_record(place);
    const Result<Record> record = bytes ? read_record_bytes(*bytes) : tl::unexpected(bytes.error());
    if (record)
      page.pictures[place.job] = picture_of(*record);
    else
      fmt::print(stderr, "{} job {} has no picture: {}\n", ink("note:", Ink::yellow, stderr), place.job, record.error().message);
  }
}

Result<ReportPage> make_page(const std::filesystem::path& farm) {
  Result<FarmLink> link = FarmLink::open(farm);
  if (!link) return tl::unexpected(link.error());
  const Result<wire::Answer> answer = link->ask("status", json::object());
  if (!answer) return tl::unexpected(answer.error());
  const json status = json::parse(answer->body);
  ReportPage page;
  std::set<std::string> names;
  for (const json& campaign : status.at("campaigns")) names.insert(campaign.at("name").get<std::string>());
  page.title = names.empty() ? "empty farm" : fmt::format("Campaign {}", fmt::join(names, ", "));
  page.generated = utc_text(SystemClock{}.wall_s());
  page.build_id = status.at("build_id").get<std::string>();
  page.counts = status.at("counts").get<std::map<std::string, std::uint64_t>>();
  page.faults = status.at("faults").get<std::map<std::string, std::uint64_t>>();
  if (auto gathered = gather_runs(*link, page); !gathered) return tl::unexpected(gathered.error());
  const std::set<std::uint64_t> drawn = jobs_to_draw(page.runs);
  const auto places = record_places(*link, farm, [&](std::uint64_t job) { return drawn.contains(job); });
  if (!places) return tl::unexpected(places.error());
  draw_pictures(*places, page);
  return page;
}

}  // namespace

int run_report(int argc, char** argv) {
  FarmOptions options;
  std::filesystem::path output = "report.html";
  Command app{"The campaign as one HTML page that needs nothing else: picture grid, times to failure, tables.", "fracfarm report"};
  add_farm_options(app, options);
  app.add_option("-o,--output", output, "the page to write").with_default_shown();
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&]() -> int {
    const Result<ReportPage> page = make_page(options.farm);
    if (!page) return report_unreachable(page.error(), options.json);
    if (const auto wrote = write_atomically(output, report_html(*page)); !wrote) return report_error(wrote.error(), options.json);
    if (options.json)
      fmt::print("{}\n", json{{"schema", "fracfarm.report/1"},
                              {"page", output.string()},
                              {"runs", page->runs.size() + page->runs_left_out},
                              {"pictures", page->pictures.size()}}
                             .dump());
    else
      fmt::print("{}: {} runs, {} with pictures\n", output.string(), page->runs.size() + page->runs_left_out, page->pictures.size());
    return exit_ok;
  });
}

}  // namespace fracfarm::cli
