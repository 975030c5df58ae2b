#include "coordinator/ledger_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "common/base/atomic_file.hpp"

namespace fracfarm {
namespace {

struct NetworkFileSystem {
  unsigned long magic;  // of statfs(2), or of the file system's own sources
  std::string_view name;
};
constexpr std::array<NetworkFileSystem, 11> network_file_systems{{
    {0x6969, "NFS"},
    {0x0bd00bd0, "Lustre"},
    {0x47504653, "GPFS"},
    {0x00c36400, "Ceph"},
    {0xff534d42, "CIFS"},
    {0xfe534d42, "SMB2"},
    {0x517b, "SMB"},
    {0x19830326, "BeeGFS"},
    {0x013111a8, "WekaFS"},
    {0xaad7aaea, "PanFS"},
    {0x5346414f, "AFS"},
}};

}  // namespace

std::optional<std::string> network_file_system(long statfs_type) {
  for (const NetworkFileSystem& row : network_file_systems)
    if (static_cast<unsigned>(statfs_type) == row.magic) return std::string(row.name);
  return std::nullopt;
}

Result<void> demand_local_disk(const std::filesystem::path& folder, std::optional<long> type) {
  struct statfs facts {};
  if (!type && ::statfs(folder.c_str(), &facts) != 0)
    return fail(Fault::node_lost, fmt::format("cannot look at {}: {}", folder.string(), std::strerror(errno)));
  const std::optional<std::string> network = network_file_system(type ? *type : static_cast<long>(facts.f_type));
  if (!network) return {};
  return fail(
      Fault::bad_request,
      fmt::format("the ledger cannot lie in {}: that is {}, where its write-ahead log loses data; make a folder on a local disk of the "
                  "machine that runs the coordinator and link it: mkdir -p /var/tmp/fracfarm/NAME && ln -s /var/tmp/fracfarm/NAME {}",
                  folder.string(), *network, folder.string()));
}

Result<LedgerLock> LedgerLock::take(const std::filesystem::path& file, double patience_s, std::string_view holder) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) return fail(Fault::node_lost, fmt::format("cannot open {}: {}", file.string(), std::strerror(errno)));
  LedgerLock lock(descriptor);
  const auto last = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR)
      return fail(Fault::node_lost, fmt::format("cannot lock {}: {}", file.string(), std::strerror(errno)));
    if (std::chrono::steady_clock::now() >= last)
      return fail(Fault::node_lost, fmt::format("the ledger in {} is held by another process", file.parent_path().string()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const bool written =
      ::ftruncate(descriptor, 0) == 0 && ::pwrite(descriptor, holder.data(), holder.size(), 0) == static_cast<ssize_t>(holder.size());
  if (!written) return fail(Fault::node_lost, fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
  return lock;
}

std::string last_holder(const FarmPaths& paths) { return read_file(paths.lock(), 64).value_or(std::string()); }

LedgerLock::~LedgerLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}
LedgerLock::LedgerLock(LedgerLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
LedgerLock& LedgerLock::operator=(LedgerLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

}  // namespace fracfarm
