// Do the shards hold what the ledger says? Reads each record's bytes by shard, offset and length and compares the digest; finds what lies
// in a shard and in no ledger. Changes nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace fracfarm {

struct RecordPlace {
  std::uint64_t job = 0;
  std::string key;
  std::filesystem::path shard;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string sha256;
};

// The record's bytes, with the digest of the ledger. Errors: OUTPUT_BAD with what is wrong (missing, short, other digest).
Result<std::string> read_record(const RecordPlace& place);

struct ShardEntry {
  std::string name;
  std::uint64_t offset = 0;  // of its bytes
  std::uint64_t length = 0;
};
// The entries of a plain tar up to its end, or to the first block that is no sound header: a torn tail after a crash is no mistake.
std::vector<ShardEntry> shard_entries(const std::filesystem::path& shard);

}  // namespace fracfarm
