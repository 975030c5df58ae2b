// A shard: a plain tar on the shared file system to which one run of one worker appends records. What is committed is synced, read back and
// compared; a shard is never appended to by a later run of the worker, so a torn tail stays where it is and harms nobody.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace fracfarm::worker {

// Where bytes lie in a shard.
struct Placed {
  std::string shard;  // file name in the store
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string sha256;
};

struct ShardOptions {
  std::filesystem::path store;
  std::string worker;  // name; part of the file name
  int records = 1000;  // then the next shard is begun
  std::uint64_t bytes = 4ull << 30;
  std::function<void(const std::filesystem::path&)> after_sync = {};  // a door for tests: called between fsync and reading back
};

class ShardWriter {
 public:
  ShardWriter(ShardOptions options, Clock& clock);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  // Appends one entry, not yet durable, whose digest the caller knows. Errors: NODE_LOST (disk full, store not there); the shard stays
  // sound.
  Result<void> append(const std::string& name, std::string_view bytes, const std::string& sha256);
  // Makes everything that was appended since the last commit durable; one result for each, in order. Where the sync fails all are
  // NODE_LOST; where bytes read back differently that one is OUTPUT_BAD. In both cases the shard is left behind and the next append begins
  // another.
  std::vector<Result<Placed>> commit();
  std::size_t uncommitted() const { return pending_.size(); }

 private:
  Result<void> begin();
  Result<void> sync();
  struct Pending {
    Placed placed;
    std::string xxh3;  // tells a changed byte as surely as SHA-256 does, in a tenth of the time
  };
  Result<void> read_back(const Pending& pending) const;
  void leave();

  ShardOptions options_;
  Clock& clock_;
  int fd_ = -1;
  std::filesystem::path path_;
  std::uint64_t end_ = 0;  // where the next header goes
  int entries_ = 0;
  std::vector<Pending> pending_;
};

// The bytes of one entry, by what the ledger knows. Errors: NODE_LOST where the file cannot be read, OUTPUT_BAD where it ends before.
Result<std::string> read_entry(const std::filesystem::path& shard, std::uint64_t offset, std::uint64_t length);

struct ShardListing {
  struct Entry {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  std::vector<Entry> entries;
  bool torn = false;  // it does not end as an archive does: its writer was killed between two commits
};
Result<ShardListing> list_entries(const std::filesystem::path& shard);

}  // namespace fracfarm::worker
