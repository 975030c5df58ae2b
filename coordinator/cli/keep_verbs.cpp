// Verbs that keep a farm's ledger: backup, restore, rebuild.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/wire/endpoint.hpp"
#include "coordinator/cli/adopt_records.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/enrolment.hpp"
#include "coordinator/ledger_backup.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uint64_t epoch_gap = 1000;  // starts since the copy was made that nobody knows of any more

// Leases that were given after the copy was made must never be given again.
void leave_epochs_behind(Ledger& ledger, const fs::path& farm) {
  const Result<wire::Endpoint> endpoint = wire::read_endpoint(farm);
  const std::string known = meta_value(ledger.reading(), "epoch");
  const std::uint64_t own = known.empty() ? 0 : std::stoull(known);
  ledger.begin();
  ledger.set_meta("epoch", std::to_string(std::max(own, endpoint ? endpoint->epoch : 0) + epoch_gap));
  ledger.commit();
}

json adopted_json(std::string_view schema, const AdoptedStores& found) {
  json refused = json::array();
  for (const AdoptedStores::Refused& it : found.refused)
    refused.push_back({{"shard", it.shard.string()}, {"entry", it.entry}, {"why", it.why}});
  return {{"schema", schema},           {"entries", found.entries}, {"known", found.count.known}, {"adopted", found.count.adopted},
          {"loose", found.count.loose}, {"refused", refused}};
}

int report_adopted(const FarmOptions& options, std::string_view schema, const AdoptedStores& found) {
  if (options.json) return fmt::print("{}\n", adopted_json(schema, found).dump(2)), exit_ok;
  fmt::print("{} records in the shards: {} known already, {} adopted, {} of no campaign of this ledger, {} refused\n", found.entries,
             found.count.known, found.count.adopted, found.count.loose, found.refused.size());
  for (const AdoptedStores::Refused& it : found.refused)
    fmt::print("refused: {} in {}: {}\n", it.entry, it.shard.filename().string(), it.why);
  if (found.count.loose) fmt::print("submit their campaigns: jobs that are here already are not computed again\n");
  return exit_ok;
}

int rebuild(const FarmOptions& options, const std::vector<fs::path>& files, const std::vector<fs::path>& more_stores) {
  const FarmPaths paths{options.farm};
  std::error_code none;
  if (fs::exists(paths.ledger(), none))
    return report_error(
        {Fault::bad_request, fmt::format("{} is there: move it away first, or use fracfarm restore, which adopts what a ledger lacks",
                                         paths.ledger().string())},
        options.json);
  std::vector<Campaign> campaigns;
  for (const fs::path& file : files) {
    const Parsed<Campaign> campaign = load_campaign(file);
    if (!campaign) return report_problems(campaign.error(), file.string(), options.json);
    campaigns.push_back(*campaign);
  }
  Result<Ledger> ledger = Ledger::open(paths, true);
  if (!ledger) return report_unreachable(ledger.error(), options.json);
  leave_epochs_behind(*ledger, options.farm);
  CampaignBook book;
  ledger->begin();
  for (const Campaign& campaign : campaigns) {
    const std::int64_t id =
        ledger->add_campaign(campaign.name, canonical_text(campaign), build_info().build_id, job_count(campaign), SystemClock{}.wall_s());
    if (const Result<void> made = enrol(*ledger, book, id); !made) return report_error(made.error(), options.json);
  }
  if (!campaigns.empty()) ledger->set_build_id(build_info().build_id);
  ledger->commit();
  std::set<fs::path> stores = stores_of(*ledger, options.farm);
  stores.insert(more_stores.begin(), more_stores.end());
  return report_adopted(options, "fracfarm.rebuild/1", adopt_stores(*ledger, stores));
}

int restore(const FarmOptions& options, const fs::path& file) {
  const FarmPaths paths{options.farm};
  if (const Result<void> done = put_back_ledger(paths, file); !done) return report_unreachable(done.error(), options.json);
  Result<Ledger> ledger = Ledger::open(paths, false);
  if (!ledger) return report_unreachable(ledger.error(), options.json);
  leave_epochs_behind(*ledger, options.farm);
  return report_adopted(options, "fracfarm.restore/1", adopt_stores(*ledger, stores_of(*ledger, options.farm)));
}

int backup(const FarmOptions& options, const fs::path& file) {
  const FarmPaths paths{options.farm};
  fs::path name = file;
  if (name.empty()) {
    const Result<fs::path> made = back_up_farm(paths, SystemClock{}.wall_s());
    if (!made) return report_unreachable(made.error(), options.json);
    name = *made;
  } else if (const Result<void> done = back_up_ledger(paths.ledger(), name); !done) {
    return report_unreachable(done.error(), options.json);
  }
  std::error_code none;
  const std::uint64_t bytes = fs::file_size(name, none);
  if (options.json)
    fmt::print("{}\n", json{{"schema", "fracfarm.backup/1"}, {"file", name.string()}, {"bytes", bytes}}.dump(2));
  else
    fmt::print("{} ({} bytes); fracfarm restore puts it back\n", name.string(), bytes);
  return exit_ok;
}

}  // namespace

int run_backup(int argc, char** argv) {
  FarmOptions options;
  fs::path file;
  Command app{
      "Copies the ledger as it stands at one moment, also while a coordinator serves it, and checks the copy. On the coordinator's "
      "machine.",
      "fracfarm backup"};
  add_farm_options(app, options);
  app.add_option("FILE", file, "where to; default: a dated file in FARM/backups, of which the latest three are kept");
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return backup(options, file); });
}

int run_restore(int argc, char** argv) {
  FarmOptions options;
  fs::path file;
  Command app{
      "Puts a copy of the ledger back and adopts from the shards what was done since it was made. The ledger that was there stays as "
      "ledger.db.before-restore. No coordinator may run.",
      "fracfarm restore"};
  add_farm_options(app, options);
  app.add_option("FILE", file, "a copy that fracfarm backup made").required();
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return restore(options, file); });
}

int run_rebuild(int argc, char** argv) {
  FarmOptions options;
  std::vector<fs::path> campaigns, stores;
  Command app{
      "Makes a ledger from the shards alone: every record is checked by every rule and becomes its job's result. With the campaign files "
      "the "
      "jobs that are still to be done are there as well; without, submit them later: nothing is computed twice.",
      "fracfarm rebuild"};
  add_farm_options(app, options);
  app.add_option("CAMPAIGN", campaigns, "campaign files");
  app.add_option("--store", stores, "a folder of shards besides FARM/store and those of the campaigns");
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return rebuild(options, campaigns, stores); });
}

}  // namespace fracfarm::cli
