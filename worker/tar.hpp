// Headers of a plain POSIX ustar archive, only what a shard needs: regular files, mtime 0, uid and gid 0, names of at most 100 bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fracfarm::worker {

inline constexpr std::size_t tar_block = 512;
using TarHeader = std::array<char, tar_block>;

struct TarEntry {
  std::string name;
  std::uint64_t length = 0;  // bytes
};

// length < 8 GiB (the format's limit, asserted).
TarHeader tar_header(const TarEntry& entry);
// Nothing where the block is no header of a regular file with a sound checksum.
std::optional<TarEntry> read_tar_header(const TarHeader& header);
bool is_zero_block(const TarHeader& header);

constexpr std::uint64_t padded(std::uint64_t length) { return (length + tar_block - 1) / tar_block * tar_block; }

}  // namespace fracfarm::worker
