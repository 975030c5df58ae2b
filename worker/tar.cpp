#include "worker/tar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace fracfarm::worker {
namespace {

// Field of the header: where it starts and how long it is (POSIX.1-2001, ustar interchange format).
struct Span {
  std::size_t at;
  std::size_t length;
};
constexpr Span name_field{0, 100}, mode_field{100, 8}, uid_field{108, 8}, gid_field{116, 8}, size_field{124, 12}, mtime_field{136, 12},
    checksum_field{148, 8}, type_field{156, 1}, magic_field{257, 8};
constexpr std::string_view magic("ustar\00000", 8);

void put(TarHeader& header, Span field, std::string_view text) {
  assert(text.size() <= field.length);
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(field.at));
}

void put_octal(TarHeader& header, Span field, std::uint64_t value) { put(header, field, fmt::format("{:0{}o}", value, field.length - 1)); }

std::string_view get(const TarHeader& header, Span field) { return {header.data() + field.at, field.length}; }

std::optional<std::uint64_t> get_octal(const TarHeader& header, Span field) {
  std::uint64_t value = 0;
  bool any = false;
  for (const char c : get(header, field)) {
    if (c == '\0' || c == ' ') break;
    if (c < '0' || c > '7') return std::nullopt;
    value = 8 * value + static_cast<std::uint64_t>(c - '0');
    any = true;
  }
  return any ? std::optional(value) : std::nullopt;
}

// Sum of all bytes with the checksum field as blanks.
std::uint64_t checksum(const TarHeader& header) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const bool own = i >= checksum_field.at && i < checksum_field.at + checksum_field.length;
    sum += own ? static_cast<unsigned char>(' ') : static_cast<unsigned char>(header[i]);
  }
  return sum;
}

}  // namespace

TarHeader tar_header(const TarEntry& entry) {
  assert(entry.length < (1ull << 33));
  TarHeader header{};
  put(header, name_field, entry.name);
  put_octal(header, mode_field, 0644);
  put_octal(header, uid_field, 0);
  put_octal(header, gid_field, 0);
  put_octal(header, size_field, entry.length);
  put_octal(header, mtime_field, 0);
  put(header, type_field, "0");
  put(header, magic_field, magic);
  put(header, checksum_field, fmt::format("{:06o}", checksum(header)) + std::string("\0 ", 2));
  return header;
}

std::optional<TarEntry> read_tar_header(const TarHeader& header) {
  const auto length = get_octal(header, size_field);
  const auto sum = get_octal(header, checksum_field);
  if (!length || sum != checksum(header) || get(header, magic_field) != magic || get(header, type_field) != "0") return std::nullopt;
  const std::string_view name = get(header, name_field);
  return TarEntry{std::string(name.substr(0, std::min(name.find('\0'), name.size()))), *length};
}

bool is_zero_block(const TarHeader& header) {
  return std::all_of(header.begin(), header.end(), [](char c) { return c == '\0'; });
}

}  // namespace fracfarm::worker
