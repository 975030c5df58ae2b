// fracfarm verify: proves that ledger and shards agree, by reading every record again.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/record/check.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/record_places.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

// Spreads ids evenly over [0, 1), another way every day, so that a daily sample reads everything in time.
double hash_share(std::uint64_t job) {
  const auto day = static_cast<std::uint64_t>(SystemClock{}.wall_s() / 86400.0);
  return static_cast<double>(((job ^ (day * 0xD1B54A32D192ED03ull)) * 0x9E3779B97F4A7C15ull) >> 11) / static_cast<double>(1ull << 53);
}

struct Damage {
  RecordPlace place;
  std::string what;
};

struct Orphan {
  std::filesystem::path shard;
  ShardEntry entry;
};

// In the order in which they lie, so that each shard is read once from end to end.
void sort_by_place(std::vector<RecordPlace>& places) {
  std::sort(places.begin(), places.end(),
            [](const RecordPlace& a, const RecordPlace& b) { return std::tie(a.shard, a.offset) < std::tie(b.shard, b.offset); });
}

// What is wrong with one record, or empty.
std::string audit(const RecordPlace& place, bool digests_only) {
  const Result<std::string> bytes = read_record(place);
  if (!bytes) return bytes.error().message;
  if (digests_only) return {};
  for (const Check& check : check_record_bytes(*bytes, {place.key}).checks)
    if (!check.passed) return fmt::format("breaks the rule '{}': {}", check.name, check.detail);
  return {};
}

std::vector<Damage> audit_all(const std::vector<RecordPlace>& places, bool digests_only) {
  std::vector<Damage> damages;
  ProgressLine line;
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  for (std::size_t at = 0; at < places.size(); ++at) {
    if (std::string what = audit(places[at], digests_only); !what.empty()) damages.push_back({places[at], std::move(what)});
    const double elapsed_s = clock.monotonic_s() - began_s;
    if (elapsed_s > 2.0)
      line.show(fmt::format("{} of {} records read, {} damaged · {} left", at + 1, places.size(), damages.size(),
                            duration_text(elapsed_s * static_cast<double>(places.size() - at - 1) / static_cast<double>(at + 1))));
  }
  return damages;
}

// Entries that no ledger row points at: results that came second, or that a crash cut off before they were acknowledged.
std::vector<Orphan> find_orphans(const std::vector<RecordPlace>& places, const std::set<std::filesystem::path>& stores) {
  std::map<std::filesystem::path, std::set<std::uint64_t>> owned;
  for (const RecordPlace& place : places) owned[place.shard].insert(place.offset);
  std::vector<Orphan> orphans;
  std::error_code error;
  for (const std::filesystem::path& store : stores)
    for (std::filesystem::directory_iterator file(store, error), end; !error && file != end; file.increment(error)) {
      if (file->path().extension() != ".tar") continue;
      for (ShardEntry& entry : shard_entries(file->path()))
        if (!owned[file->path()].contains(entry.offset)) orphans.push_back({file->path(), std::move(entry)});
    }
  return orphans;
}

json report_json(std::size_t records, const std::vector<Damage>& damages, const std::vector<Orphan>& orphans, std::uint64_t repairs) {
  json damaged = json::array(), left_over = json::array();
  for (const Damage& it : damages)
    damaged.push_back(
        {{"job", it.place.job}, {"key", it.place.key}, {"shard", it.place.shard.string()}, {"offset", it.place.offset}, {"what", it.what}});
  for (const Orphan& it : orphans)
    left_over.push_back({{"shard", it.shard.string()}, {"name", it.entry.name}, {"offset", it.entry.offset}, {"length", it.entry.length}});
  return {{"schema", "fracfarm.verify/1"},
          {"records", records},
          {"sound", records - damages.size()},
          {"damaged", damaged},
          {"repairs", repairs},
          {"orphans", left_over}};
}

// DONE stays DONE; their bytes are computed again. How many will be.
Result<std::uint64_t> ask_repair(const FarmOptions& options, const std::vector<Damage>& damages) {
  json jobs = json::array();
  for (const Damage& it : damages) jobs.push_back(it.place.job);
  Result<FarmLink> link = FarmLink::open(options.farm);
  if (!link) return tl::unexpected(link.error());
  const Result<wire::Answer> answer = link->ask("recheck", {{"jobs", jobs}, {"repair", true}});
  if (!answer) return tl::unexpected(answer.error());
  return json::parse(answer->body).value("changed", std::uint64_t{0});
}

int verify(const FarmOptions& options, bool digests_only, double sample, bool repair) {
  std::vector<RecordPlace> places;
  {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), options.json);
    Result<std::vector<RecordPlace>> found =
        record_places(*link, options.farm, [&](std::uint64_t job) { return sample >= 1.0 || hash_share(job) < sample; });
    if (!found) return report_unreachable(found.error(), options.json);
    places = std::move(*found);
  }  // lets go of the ledger: reading the records takes its time
  sort_by_place(places);
  std::set<std::filesystem::path> stores;
  for (const RecordPlace& place : places) stores.insert(place.shard.parent_path());
  const std::vector<Orphan> orphans = sample < 1.0 ? std::vector<Orphan>{} : find_orphans(places, stores);
  const std::vector<Damage> damages = audit_all(places, digests_only);
  const int exit_code = damages.empty() ? exit_ok : exit_failed;
  const Result<std::uint64_t> repairs = !damages.empty() && repair ? ask_repair(options, damages) : Result<std::uint64_t>(0);
  if (!repairs) return report_unreachable(repairs.error(), options.json);
  if (options.json) return fmt::print("{}\n", report_json(places.size(), damages, orphans, *repairs).dump(2)), exit_code;
  for (const Damage& it : damages) fmt::print("{} job {}: {}\n", ink("damaged:", Ink::red, stdout), it.place.job, it.what);
  fmt::print("{} records, {} sound, {} damaged or missing\n", places.size(), places.size() - damages.size(), damages.size());
  if (!orphans.empty())
    fmt::print("{} entries of shards belong to no job: second results, or cut off before they were acknowledged; harmless\n",
               orphans.size());
  if (*repairs > 0) fmt::print("to be computed again: {} job{}\n", *repairs, *repairs == 1 ? "" : "s");
  if (!damages.empty() && !repair) fmt::print("fracfarm verify --repair, or fracfarm recheck --repair JOB, computes them again\n");
  return exit_code;
}

}  // namespace

int run_verify(int argc, char** argv) {
  FarmOptions options;
  bool digests_only = false, repair = false;
  double sample = 1.0;
  Command app{
      "Reads every record of the ledger again: are its bytes there, have they the digest, do they keep every rule? Exit status 1 where one "
      "does not.",
      "fracfarm verify"};
  add_farm_options(app, options);
  app.add_flag("--digests-only", digests_only, "compare digests, do not check the records' content");
  app.add_option("--sample", sample, "read this share of the records, others every day").in_range(0.0, 1.0);
  app.add_flag("--repair", repair, "have damaged records computed again");
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return verify(options, digests_only, sample, repair); });
}

}  // namespace fracfarm::cli
