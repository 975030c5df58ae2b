#include "coordinator/shard_audit.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <optional>

#include "common/base/hash.hpp"

namespace fracfarm {
namespace {

constexpr std::uint64_t largest_record = 1ull << 30;
constexpr std::size_t block = 512;
using Header = std::array<char, block>;

std::optional<std::uint64_t> octal(const char* digits, std::size_t most) {
  std::uint64_t value = 0;
  std::size_t at = 0;
  for (; at < most && digits[at] >= '0' && digits[at] <= '7'; ++at) value = value * 8 + static_cast<std::uint64_t>(digits[at] - '0');
  if (at == 0) return std::nullopt;
  return value;
}

// ustar: the sum of all bytes with the checksum field as blanks.
bool sound(const Header& header) {
  std::uint64_t sum = 0;
  for (std::size_t at = 0; at < block; ++at) sum += at >= 148 && at < 156 ? ' ' : static_cast<unsigned char>(header[at]);
  return octal(header.data() + 148, 8) == sum && std::memcmp(header.data() + 257, "ustar", 5) == 0;
}

}  // namespace

Result<std::string> read_record(const RecordPlace& place) {
  const auto bad = [&](std::string what) { return fail(Fault::output_bad, std::move(what)); };
  if (place.length > largest_record) return bad(fmt::format("a length of {} bytes is none of a record", place.length));
  std::ifstream file(place.shard, std::ios::binary);
  if (!file) return bad(fmt::format("{} is missing or cannot be read", place.shard.string()));
  std::string bytes(place.length, '\0');
  file.seekg(static_cast<std::streamoff>(place.offset));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uint64_t>(file.gcount()) != place.length)
    return bad(fmt::format("{} ends before byte {}", place.shard.string(), place.offset + place.length));
  if (sha256_hex(bytes) != place.sha256)
    return bad(fmt::format("{} at byte {}: other bytes than were acknowledged", place.shard.string(), place.offset));
  return bytes;
}

std::vector<ShardEntry> shard_entries(const std::filesystem::path& shard) {
  std::vector<ShardEntry> entries;
  std::ifstream file(shard, std::ios::binary);
  Header header;
  for (std::uint64_t at = 0; file.seekg(static_cast<std::streamoff>(at)) && file.read(header.data(), block) && sound(header);) {
    const std::optional<std::uint64_t> length = octal(header.data() + 124, 12);
    if (!length) break;
    entries.push_back({std::string(header.data(), ::strnlen(header.data(), 100)), at + block, *length});
    at += block + (*length + block - 1) / block * block;
  }
  return entries;
}

}  // namespace fracfarm
