// fracfarm verify: proves that ledger and shards agree, by reading every record again.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

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

json report_json(std::size_t records, const std::vector<Damage>& damages, const std::vector<Orphan>& orphans) {
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
          {"orphans", left_over}};
}

int verify(const FarmOptions& options, bool digests_only) {
  std::vector<RecordPlace> places;
  {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), options.json);
    Result<std::vector<RecordPlace>> found = record_places(*link, options.farm, [](std::uint64_t) { return true; });
    if (!found) return report_unreachable(found.error(), options.json);
    places = std::move(*found);
  }  // lets go of the ledger: reading the records takes its time
  sort_by_place(places);
  std::set<std::filesystem::path> stores;
  for (const RecordPlace& place : places) stores.insert(place.shard.parent_path());
  const std::vector<Orphan> orphans = find_orphans(places, stores);
  const std::vector<Damage> damages = audit_all(places, digests_only);
  const int exit_code = damages.empty() ? exit_ok : exit_failed;
  if (options.json) return fmt::print("{}\n", report_json(places.size(), damages, orphans).dump(2)), exit_code;
  for (const Damage& it : damages) fmt::print("{} job {}: {}\n", ink("damaged:", Ink::red, stdout), it.place.job, it.what);
  fmt::print("{} records, {} sound, {} damaged or missing\n", places.size(), places.size() - damages.size(), damages.size());
  if (!orphans.empty())
    fmt::print("{} entries of shards belong to no job: second results, or cut off before they were acknowledged; harmless\n",
               orphans.size());
  if (!damages.empty())
    fmt::print("to compute a damaged one again, begin another farm with its campaign, or restore the shard from a copy\n");
  return exit_code;
}

}  // namespace

int run_verify(int argc, char** argv) {
  FarmOptions options;
  bool digests_only = false;
  CLI::App app{
      "Reads every record of the ledger again: are its bytes there, have they the digest, do they keep every rule? Exit status 1 where one "
      "does not.",
      "fracfarm verify"};
  add_farm_options(app, options);
  app.add_flag("--digests-only", digests_only, "compare digests, do not check the records' content");
  if (const auto status = parse(app, argc, argv)) return *status;
  return guarded(options, [&] { return verify(options, digests_only); });
}

}  // namespace fracfarm::cli
