// fracfarm extract: copies records out of the store, each compared with the ledger's digest on the way.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/record_places.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

struct Found {
  int exit_code = exit_ok;
  std::vector<RecordPlace> places;
};

// Every job must be there and have a record before anything is written.
Found find_records(const FarmOptions& options, const std::vector<std::string>& jobs) {
  Result<FarmLink> link = FarmLink::open(options.farm);
  if (!link) return {report_unreachable(link.error(), options.json), {}};
  Found found;
  Problems problems;
  for (const std::string& word : jobs) {
    const Result<wire::Answer> job = link->ask("explain", {{"job", word}});
    if (!job) return {report_unreachable(job.error(), options.json), {}};
    const json body = json::parse(job->body);
    if (job->exit_code != exit_ok) {
      problems.push_back({"job", word, "the id of a job, or the first characters of its key", body.value("message", "")});
      continue;
    }
    const auto place = record_place(*link, options.farm, body.value("id", std::uint64_t{0}));
    if (!place) return {report_unreachable(place.error(), options.json), {}};
    if (*place)
      found.places.push_back(**place);
    else
      problems.push_back({"job", word, "a job that is done and has a record",
                          fmt::format("it is {}; fracfarm explain {} says why", body.value("state", ""), word)});
  }
  if (!problems.empty()) return {report_problems(problems, "extract", options.json), {}};
  return found;
}

int extract(const FarmOptions& options, const std::vector<std::string>& jobs, const std::filesystem::path& folder) {
  const Found found = find_records(options, jobs);
  if (found.exit_code != exit_ok) return found.exit_code;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  json files = json::array();
  for (const RecordPlace& place : found.places) {
    const std::filesystem::path file = folder / fmt::format("job-{}.h5", place.job);
    const Result<std::string> bytes = read_record(place);
    if (!bytes) return report_error(bytes.error(), options.json);
    if (const auto wrote = write_atomically(file, *bytes); !wrote) return report_error(wrote.error(), options.json);
    files.push_back({{"job", place.job}, {"key", place.key}, {"file", file.string()}, {"sha256", place.sha256}});
    if (!options.json) fmt::print("{}\n", file.string());
  }
  if (options.json) fmt::print("{}\n", json{{"schema", "fracfarm.extract/1"}, {"files", files}}.dump(2));
  return exit_ok;
}

}  // namespace

int run_extract(int argc, char** argv) {
  FarmOptions options;
  std::vector<std::string> jobs;
  std::filesystem::path folder = ".";
  Command app{"Copies the records of jobs out of the store as job-ID.h5, each compared with the ledger's digest.", "fracfarm extract"};
  add_farm_options(app, options);
  app.add_option("job", jobs, "ids, or the first characters of keys").required();
  app.add_option("-o,--output", folder, "folder to write into").with_default_shown();
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return extract(options, jobs, folder); });
}

}  // namespace fracfarm::cli
