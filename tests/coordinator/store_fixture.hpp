// A farm's store with sound records of a campaign's jobs: small ones that no solver made, but that keep every rule.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/hash.hpp"
#include "common/record/writer.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/shard_audit.hpp"
#include "tests/record/sample_record.hpp"
#include "worker/shard.hpp"

namespace fracfarm::test {

// Jobs that differ in their sample alone, so that one set of fields fits all.
inline std::string store_campaign_text(int patterns, const std::string& name = "stored") {
  return fmt::format(
      R"({{"name": "{}", "seed": 7, "jobs": [{{"method": "phase_field", "materials": ["pbx"], "loads": ["uniaxial"], "patterns": {{"orthogonal": "1-{}"}},
    "set": {{"cracks": [[0.02, 0.1, 0.06, 0.1], [0.2, 0.05, 0.2, 0.08]], "domain.height": 0.2, "phase_field.cells": [15, 11],
             "time.frame_interval": 5e-6, "time.horizon": 1e-3}}}}]}})",
      name, patterns);
}

// The record of the job at `position`; `attempt` changes its bytes and no physics.
inline Record stored_record(const Campaign& campaign, std::uint64_t position, int attempt = 1) {
  Record record = sample::record();
  const JobSpec spec = job_at(campaign, position);
  record.canonical_scene = scene_text(campaign, position);
  record.key = job_key(record.canonical_scene, record.provenance["build_id"]);
  record.boundary_condition = spec.load;
  record.sample_id = spec.sample_id;
  record.pattern_seed = campaign.seed;
  record.provenance["attempt"] = std::to_string(attempt);
  record.provenance["steps"] = "180";
  record.provenance["wall_s"] = "0.25";
  record.provenance["cpu_s"] = "0.2";
  return record;
}

struct Stored {
  RecordPlace place;
  wire::Completion completion;  // without a lease
};

// Appends records to new shards of `store`.
inline std::vector<Stored> store_all(const std::vector<Record>& records, const std::filesystem::path& store, const std::string& worker,
                                     int a_shard) {
  SystemClock clock;
  std::filesystem::create_directories(store);
  worker::ShardWriter writer({.store = store, .worker = worker, .records = a_shard}, clock);
  std::vector<Stored> stored;
  for (const Record& record : records) {
    const std::string bytes = record_bytes(record).value();
    if (!writer.append(record.key + ".h5", bytes, sha256_hex(bytes))) break;
    const worker::Placed placed = writer.commit().at(0).value();
    wire::Completion completion{{},
                                record.key,
                                record.judgement.verdict,
                                record.judgement.time_to_failure,
                                record.judgement.rule,
                                record.peak_stress,
                                180,
                                0.2,
                                0.25,
                                placed.shard,
                                placed.offset,
                                placed.length,
                                placed.sha256};
    stored.push_back({{0, record.key, store / placed.shard, placed.offset, placed.length, placed.sha256}, std::move(completion)});
  }
  return stored;
}

// Those of positions first to last of a campaign.
inline std::vector<Stored> store_records(const Campaign& campaign, const std::filesystem::path& store, std::uint64_t first,
                                         std::uint64_t last, const std::string& worker = "w", int a_shard = 8) {
  std::vector<Record> records;
  for (std::uint64_t position = first; position <= last; ++position) records.push_back(stored_record(campaign, position));
  return store_all(records, store, worker, a_shard);
}

}  // namespace fracfarm::test
