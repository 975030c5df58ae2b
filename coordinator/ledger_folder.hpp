// Where a farm keeps its ledger, and who may open it: FARM/ledger/ on a local disk (it may be a symbolic link to one), one holder at a
// time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

struct FarmPaths {
  std::filesystem::path farm;
  std::filesystem::path ledger_folder() const { return farm / "ledger"; }
  std::filesystem::path ledger() const { return ledger_folder() / "ledger.db"; }
  std::filesystem::path lock() const { return ledger_folder() / "lock"; }
  std::filesystem::path endpoint() const { return farm / "endpoint.json"; }
  std::filesystem::path log_folder() const { return farm / "log"; }
};

// The name of a network file system by its statfs magic number; nothing for a local one. WAL needs memory that all openers share: it breaks
// on these.
std::optional<std::string> network_file_system(long statfs_type);
// Refuses a folder on a network file system with words on where to put it. `type` overrides what statfs says (tests).
Result<void> demand_local_disk(const std::filesystem::path& folder, std::optional<long> type = std::nullopt);

inline constexpr std::string_view holder_coordinator = "coordinator";
inline constexpr std::string_view holder_command = "command";
// Who said last that it holds the ledger; empty where nobody ever did. Only a hint: the lock itself is the truth.
std::string last_holder(const FarmPaths& paths);

// An exclusive flock; held until it ends, also by a kill.
class LedgerLock {
 public:
  // Waits up to patience_s; `holder` is written into the file, for whoever finds it locked. Errors: NODE_LOST where another holds it or the
  // file cannot be made.
  static Result<LedgerLock> take(const std::filesystem::path& file, double patience_s, std::string_view holder);
  ~LedgerLock();
  LedgerLock(LedgerLock&& other) noexcept;
  LedgerLock& operator=(LedgerLock&& other) noexcept;

 private:
  explicit LedgerLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace fracfarm
