#include "common/base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace fracfarm {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

tl::unexpected<Error> system_error(const char* doing, const fs::path& path) {
  return fail(Fault::node_lost, std::string("cannot ") + doing + " " + path.string() + ": " + std::strerror(errno));
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::write(fd, bytes.data(), bytes.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return true;
}

fs::path part_of(const fs::path& path) { return path.string() + ".part"; }

Result<void> write_new(const fs::path& path, std::string_view bytes, unsigned mode, bool sync) {
  Descriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode));
  if (fd.get() < 0) return system_error("create", path);
  if (!write_all(fd.get(), bytes)) return system_error("write", path);
  if (sync && ::fsync(fd.get()) != 0) return system_error("sync", path);
  if (!fd.close()) return system_error("close", path);
  return {};
}

Result<void> rename_file(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return system_error("rename to", to);
  return {};
}

Result<void> sync_path(const fs::path& path, int flags) {
  const Descriptor fd(::open(path.c_str(), flags | O_CLOEXEC));
  if (fd.get() < 0) return system_error("open", path);
  if (::fsync(fd.get()) != 0) return system_error("sync", path);
  return {};
}

}  // namespace

Result<void> write_atomically(const fs::path& path, std::string_view bytes, unsigned mode) {
  const fs::path part = part_of(path);
  if (auto written = write_new(part, bytes, mode, true); !written) return written;
  return commit_file(part, path);
}

Result<void> write_unsynced(const fs::path& path, std::string_view bytes, unsigned mode) {
  const fs::path part = part_of(path);
  if (auto written = write_new(part, bytes, mode, false); !written) return written;
  return rename_file(part, path);
}

Result<void> sync_file(const fs::path& path) { return sync_path(path, O_RDONLY); }

Result<void> sync_folder(const fs::path& folder) { return sync_path(folder.empty() ? fs::path(".") : folder, O_RDONLY | O_DIRECTORY); }

Result<void> commit_file(const fs::path& part, const fs::path& path) {
  if (auto renamed = rename_file(part, path); !renamed) return renamed;
  return sync_folder(path.parent_path());
}

Result<std::string> read_file(const fs::path& path, std::uint64_t max_bytes) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) return system_error("open", path);
  struct stat info {};
  if (::fstat(fd.get(), &info) != 0) return system_error("look at", path);
  if (S_ISDIR(info.st_mode)) return fail(Fault::bad_request, path.string() + " is a folder, not a file");
  std::string bytes;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(fd.get(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("read", path);
    if (got == 0) return bytes;
    if (bytes.size() + static_cast<std::size_t>(got) > max_bytes)
      return fail(Fault::bad_request, path.string() + " is larger than the limit of " + std::to_string(max_bytes) + " bytes");
    bytes.append(buffer, static_cast<std::size_t>(got));
  }
}

void drop_cached(const fs::path& path) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() >= 0) (void)::posix_fadvise(fd.get(), 0, 0, POSIX_FADV_DONTNEED);
}

}  // namespace fracfarm
