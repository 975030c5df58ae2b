// Durable files: write beside, sync, rename, sync the folder. A reader sees the old bytes or the new ones, never a part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

// Writes path.part, fsyncs, renames to path, fsyncs the folder. Errors: NODE_LOST with errno in words.
Result<void> write_atomically(const std::filesystem::path& path, std::string_view bytes, unsigned mode = 0644);

// The same without a sync, for files that another process takes at once: a reader sees all of it or nothing, a crash may take it.
Result<void> write_unsynced(const std::filesystem::path& path, std::string_view bytes, unsigned mode = 0644);

// fsync of a file, and rename of `part` to `path` with the folder synced: for writers that made `part` themselves.
Result<void> sync_file(const std::filesystem::path& path);
Result<void> commit_file(const std::filesystem::path& part, const std::filesystem::path& path);
Result<void> sync_folder(const std::filesystem::path& folder);

// Whole file as bytes; refuses one larger than max_bytes.
Result<std::string> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

// Asks the system to forget its copy of a synced file, so that the next read comes from the disk where it can.
void drop_cached(const std::filesystem::path& path);

}  // namespace fracfarm
