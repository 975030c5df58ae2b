#include "coordinator/cli/adopt_records.hpp"

#include <fmt/format.h>

#include <charconv>
#include <ctime>
#include <fstream>

#include "common/base/clock.hpp"
#include "common/base/hash.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/record/check.hpp"
#include "common/scene/parse.hpp"
#include "coordinator/shard_audit.hpp"

namespace fracfarm::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t batch = 200;  // records of one transaction

template <class T>
T number(const std::map<std::string, std::string>& provenance, const std::string& name) {
  T value{};
  if (const auto found = provenance.find(name); found != provenance.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
  return value;
}

double written_at(const std::map<std::string, std::string>& provenance) {
  const auto found = provenance.find("written");
  std::tm parts{};
  if (found == provenance.end() || !::strptime(found->second.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts)) return 0.0;
  return static_cast<double>(::timegm(&parts));
}

Outcome outcome_of(const Record& record, const std::string& bytes) {
  Outcome outcome;
  outcome.verdict = record.judgement.verdict;
  outcome.time_to_failure = record.judgement.time_to_failure;
  outcome.failure_rule = record.judgement.rule;
  outcome.peak_stress = record.peak_stress;
  outcome.steps = number<long long>(record.provenance, "steps");
  outcome.cpu_s = number<double>(record.provenance, "cpu_s");
  outcome.wall_s = number<double>(record.provenance, "wall_s");
  outcome.done_at = written_at(record.provenance);
  outcome.length = bytes.size();
  outcome.sha256 = sha256_hex(bytes);
  return outcome;
}

std::string bytes_at(const fs::path& shard, const ShardEntry& entry) {
  std::string bytes(entry.length, '\0');
  std::ifstream file(shard, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(entry.offset));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

}  // namespace

Result<FoundRecord> judge_entry(const std::string& bytes, const std::string& name) {
  const auto bad = [&](std::string why) { return fail(Fault::output_bad, std::move(why)); };
  CheckedRecord checked = check_record_bytes(bytes);
  for (const Check& check : checked.checks)
    if (!check.passed) return bad(fmt::format("breaks the rule '{}': {}", check.name, check.detail));
  if (!checked.record) return bad("cannot be read");
  const Record& record = *checked.record;
  if (name != record.key + ".h5") return bad(fmt::format("is named {} and holds the record of {:.12}", name, record.key));
  const auto build = record.provenance.find("build_id");
  if (build == record.provenance.end()) return bad("does not say which build made it");
  if (job_key(record.canonical_scene, build->second) != record.key) return bad("its key is not that of its scene and build");
  Parsed<Scene> scene = parse_scene(record.canonical_scene);
  if (!scene) return bad("its scene is not one that this program reads");
  return FoundRecord{record.key, build->second, std::move(*scene), outcome_of(record, bytes)};
}

AdoptedStores adopt_stores(Ledger& ledger, const std::set<fs::path>& stores) {
  AdoptedStores found;
  std::vector<FoundRecord> loose;
  CampaignBook book;
  ProgressLine line;
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  std::size_t open = 0;
  ledger.begin();
  for (const fs::path& store : stores) {
    std::set<fs::path> shards;  // by name: the same ledger from the same shards
    std::error_code error;
    for (fs::directory_iterator file(store, error), end; !error && file != end; file.increment(error))
      if (file->path().extension() == ".tar") shards.insert(file->path());
    for (const fs::path& shard : shards)
      for (const ShardEntry& entry : shard_entries(shard)) {
        ++found.entries;
        Result<FoundRecord> record = judge_entry(bytes_at(shard, entry), entry.name);
        if (!record) {
          found.refused.push_back({shard, entry.name, record.error().message});
          continue;
        }
        record->outcome.shard = shard.filename().string();
        record->outcome.offset = entry.offset;
        adopt(ledger, book, *record, found.count, loose);
        if (++open % batch == 0) ledger.commit(), ledger.begin();
        if (clock.monotonic_s() - began_s > 2.0)
          line.show(fmt::format("{} records read from {} ({:.0f}/s), {} refused", found.entries, shard.filename().string(),
                                static_cast<double>(found.entries) / (clock.monotonic_s() - began_s), found.refused.size()));
      }
  }
  add_loose(ledger, loose, clock.wall_s());
  found.count.loose = loose.size();
  ledger.commit();
  return found;
}

std::set<fs::path> stores_of(Ledger& ledger, const fs::path& farm) {
  std::set<fs::path> stores{farm / "store"};
  CampaignBook book;
  for (const CampaignRow& row : campaign_rows(ledger.reading()))
    if (const auto campaign = book.open(ledger.reading(), row.id)) stores.insert(farm / (*campaign)->store);
  return stores;
}

}  // namespace fracfarm::cli
