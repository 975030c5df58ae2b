#include "solver/checkpoint.hpp"

#include <charconv>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"

namespace fracfarm {
namespace {

constexpr std::string_view magic = "fracfarm.checkpoint/1\n";
constexpr std::size_t digest_length = 32;
constexpr std::uint64_t largest = std::uint64_t{1} << 34;  // 16 GiB: far above any run that this solver can hold

// The text up to the next newline, which is dropped with it.
std::string_view take_line(std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  const std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
  return line;
}

}  // namespace

Result<void> write_checkpoint(const std::filesystem::path& path, std::string_view identity, std::string_view payload) {
  std::string bytes(magic);
  bytes.append(identity).append("\n").append(std::to_string(payload.size())).append("\n").append(payload);
  bytes += xxh3_hex(bytes);
  return write_atomically(path, bytes);
}

CheckpointRead read_checkpoint(const std::filesystem::path& path, std::string_view identity) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  const Result<std::string> file = read_file(path, largest);
  if (!file) return {std::nullopt, "checkpoint ignored: " + file.error().message};
  std::string_view bytes = *file;
  if (!bytes.starts_with(magic)) return {std::nullopt, "checkpoint ignored: not a file of this version"};
  if (bytes.size() < magic.size() + digest_length ||
      xxh3_hex(bytes.substr(0, bytes.size() - digest_length)) != bytes.substr(bytes.size() - digest_length))
    return {std::nullopt, "checkpoint ignored: cut or damaged (checksum)"};
  bytes.remove_suffix(digest_length);
  bytes.remove_prefix(magic.size());
  if (take_line(bytes) != identity) return {std::nullopt, "checkpoint ignored: it belongs to another run"};
  const std::string_view count = take_line(bytes);
  std::uint64_t size = 0;
  std::from_chars(count.data(), count.data() + count.size(), size);
  if (size != bytes.size()) return {std::nullopt, "checkpoint ignored: wrong length"};
  return {std::string(bytes), {}};
}

}  // namespace fracfarm
