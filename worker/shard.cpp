#include "worker/shard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "worker/tar.hpp"

namespace fracfarm::worker {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t archive_end = 2 * tar_block;  // two zero blocks end an archive
constexpr std::uint64_t max_entry_bytes = 2ull << 30;

tl::unexpected<Error> system_error(const char* doing, const fs::path& path) {
  return fail(Fault::node_lost, fmt::format("cannot {} {}: {}", doing, path.string(), std::strerror(errno)));
}

bool write_all(int fd, std::string_view bytes, std::uint64_t at) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
    at += static_cast<std::uint64_t>(wrote);
  }
  return true;
}

// Bytes read, fewer than asked for only at the end of the file; -1: errno.
ssize_t read_all(int fd, char* to, std::size_t length, std::uint64_t at) {
  std::size_t done = 0;
  while (done < length) {
    const ssize_t got = ::pread(fd, to + done, length - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(done);
}

struct Reader {
  int fd;
  explicit Reader(const fs::path& path) : fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Reader() {
    if (fd >= 0) ::close(fd);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

std::string compact_utc(double wall_s) {
  std::string text = utc_text(wall_s);
  std::erase_if(text, [](char c) { return c == '-' || c == ':'; });
  return text;
}

}  // namespace

ShardWriter::ShardWriter(ShardOptions options, Clock& clock) : options_(std::move(options)), clock_(clock) {}
ShardWriter::~ShardWriter() { leave(); }

void ShardWriter::leave() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

// The first free name: a shard belongs to the run that created it.
Result<void> ShardWriter::begin() {
  std::error_code error;
  fs::create_directories(options_.store, error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot make {}: {}", options_.store.string(), error.message()));
  const std::string stem = fmt::format("shard-{}-{}", options_.worker, compact_utc(clock_.wall_s()));
  for (int n = 0; fd_ < 0; ++n) {
    path_ = options_.store / fmt::format("{}-{}.tar", stem, n);
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd_ < 0 && errno != EEXIST) return system_error("create", path_);
  }
  end_ = 0;
  entries_ = 0;
  if (auto synced = sync_folder(options_.store); !synced) return leave(), synced;
  return {};
}

Result<void> ShardWriter::append(const std::string& name, std::string_view bytes, const std::string& sha256) {
  if (bytes.size() > max_entry_bytes || name.size() > 100)
    return fail(Fault::output_bad,
                fmt::format("{} of {} bytes does not fit a shard; the limit is {}", name, bytes.size(), max_entry_bytes));
  const bool full = entries_ >= options_.records || end_ >= options_.bytes;
  if (fd_ >= 0 && full && pending_.empty()) leave();
  if (fd_ < 0)
    if (auto begun = begin(); !begun) return begun;
  const TarHeader header = tar_header({name, bytes.size()});
  const std::string padding(padded(bytes.size()) - bytes.size(), '\0');
  const std::uint64_t data = end_ + tar_block;
  if (!write_all(fd_, bytes, data) || !write_all(fd_, padding, data + bytes.size()) ||
      !write_all(fd_, {header.data(), header.size()}, end_))
    return system_error("append to", path_);
  pending_.push_back({{path_.filename().string(), data, bytes.size(), sha256}, xxh3_hex(bytes)});
  end_ = data + padded(bytes.size());
  ++entries_;
  return {};
}

Result<void> ShardWriter::sync() {
  if (!write_all(fd_, std::string(archive_end, '\0'), end_)) return system_error("end", path_);
  if (::ftruncate(fd_, static_cast<off_t>(end_ + archive_end)) != 0) return system_error("cut", path_);
  if (::fsync(fd_) != 0) return system_error("sync", path_);
  return {};
}

Result<void> ShardWriter::read_back(const Pending& pending) const {
  const Placed& placed = pending.placed;
  const auto bytes = read_entry(path_, placed.offset, placed.length);
  if (!bytes) return tl::unexpected(bytes.error());
  if (xxh3_hex(*bytes) == pending.xxh3) return {};
  return fail(Fault::output_bad, fmt::format("{} bytes at {} of {} read back differently after they were synced", placed.length,
                                             placed.offset, path_.string()));
}

std::vector<Result<Placed>> ShardWriter::commit() {
  std::vector<Result<Placed>> results;
  if (pending_.empty()) return results;
  const auto synced = sync();
  if (synced && options_.after_sync) options_.after_sync(path_);
  bool sound = synced.has_value();
  for (Pending& pending : std::exchange(pending_, {})) {
    const auto same = synced ? read_back(pending) : synced;
    sound = sound && same;
    results.push_back(same ? Result<Placed>(std::move(pending.placed)) : tl::unexpected(same.error()));
  }
  if (!sound) leave();  // a failed sync says nothing true about later ones
  return results;
}

Result<std::string> read_entry(const fs::path& shard, std::uint64_t offset, std::uint64_t length) {
  if (length > max_entry_bytes) return fail(Fault::bad_request, fmt::format("entry of {} bytes; the limit is {}", length, max_entry_bytes));
  const Reader file(shard);
  if (file.fd < 0) return system_error("open", shard);
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) return system_error("look at", shard);
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (offset > size || length > size - offset)
    return fail(Fault::output_bad, fmt::format("{} has {} bytes; {} at {} are asked for", shard.string(), size, length, offset));
  (void)::posix_fadvise(file.fd, static_cast<off_t>(offset), static_cast<off_t>(length),
                        POSIX_FADV_DONTNEED);  // from the disk, where it can be
  std::string bytes(length, '\0');
  const ssize_t got = read_all(file.fd, bytes.data(), bytes.size(), offset);
  if (got < 0) return system_error("read", shard);
  if (static_cast<std::uint64_t>(got) < length)
    return fail(Fault::output_bad, fmt::format("{} became shorter while it was read", shard.string()));
  return bytes;
}

Result<ShardListing> list_entries(const fs::path& shard) {
  const Reader file(shard);
  if (file.fd < 0) return system_error("open", shard);
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) return system_error("look at", shard);
  const auto size = static_cast<std::uint64_t>(info.st_size);
  ShardListing listing;
  for (std::uint64_t at = 0;;) {
    TarHeader header{};
    const ssize_t got = read_all(file.fd, header.data(), header.size(), at);
    if (got < 0) return system_error("read", shard);
    const bool whole = got == static_cast<ssize_t>(header.size());
    if (whole && is_zero_block(header)) return listing;
    const auto entry = whole ? read_tar_header(header) : std::nullopt;
    if (!entry || entry->length > size || at + tar_block + entry->length > size) {
      listing.torn = true;
      return listing;
    }
    listing.entries.push_back({entry->name, at + tar_block, entry->length});
    at += tar_block + padded(entry->length);
  }
}

}  // namespace fracfarm::worker
