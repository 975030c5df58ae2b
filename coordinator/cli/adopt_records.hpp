// Shards in, results out: reads every record of a farm's stores, believes those that keep every rule, and gives them to a ledger.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "coordinator/adopt.hpp"

namespace fracfarm::cli {

struct AdoptedStores {
  Adoption count;
  std::uint64_t entries = 0;  // of shards
  struct Refused {
    std::filesystem::path shard;
    std::string entry;
    std::string why;
  };
  std::vector<Refused> refused;
};

// What a shard's entry is worth as a result. Errors: OUTPUT_BAD with the first broken rule.
Result<FoundRecord> judge_entry(const std::string& bytes, const std::string& name);

// In transactions of its own; shows progress.
AdoptedStores adopt_stores(Ledger& ledger, const std::set<std::filesystem::path>& stores);

// Where the records of a farm's campaigns lie.
std::set<std::filesystem::path> stores_of(Ledger& ledger, const std::filesystem::path& farm);

}  // namespace fracfarm::cli
