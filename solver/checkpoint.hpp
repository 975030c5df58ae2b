// Checkpoint files: who it belongs to, the payload, and the XXH3-128 of both. Written atomically. A file that is damaged, cut or of another
// run is no error: it is ignored with a note, because starting again is always right.
//
//   "fracfarm.checkpoint/1\n"  identity "\n"  payload bytes (decimal) "\n"  payload  xxh3 of all before (32 hex digits)
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

// Errors: NODE_LOST where it cannot be written.
Result<void> write_checkpoint(const std::filesystem::path& path, std::string_view identity, std::string_view payload);

struct CheckpointRead {
  std::optional<std::string> payload;
  std::string note;  // why there is none, in words; empty where no file is there
};

CheckpointRead read_checkpoint(const std::filesystem::path& path, std::string_view identity);

}  // namespace fracfarm
