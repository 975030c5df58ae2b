#include "tests/simulation/fault_disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace fracfarm::simulation {
namespace {

constexpr std::size_t sector = 512;

int code_of_error(FaultDisk::Call call) {
  using Call = FaultDisk::Call;
  return call == Call::read    ? SQLITE_IOERR_READ
         : call == Call::write ? SQLITE_IOERR_WRITE
         : call == Call::sync  ? SQLITE_IOERR_FSYNC
         : call == Call::open  ? SQLITE_CANTOPEN
                               : SQLITE_IOERR;
}

}  // namespace

std::string name_of(Trouble trouble) {
  static constexpr const char* names[]{"none",    "ENOSPC",       "EIO", "short write", "torn page", "lost unsynced writes",
                                       "SIGKILL", "EIO of a sync"};
  return names[static_cast<int>(trouble)];
}

bool FaultDisk::may_have(Call call, Trouble trouble) {
  const bool puts = call == Call::write;
  switch (trouble) {
    case Trouble::none:
      return false;
    case Trouble::no_space:
    case Trouble::short_write:
    case Trouble::torn_page:
      return puts;
    case Trouble::failed_sync:
      return call == Call::sync;
    case Trouble::io_error:
    case Trouble::lost_writes:
    case Trouble::killed:
      break;
  }
  return true;
}

Trouble FaultDisk::turn(Call call) {
  calls_.push_back(call);
  if (planned_ == Trouble::none || calls_.size() <= planned_at_ || !may_have(call, planned_)) return Trouble::none;
  return std::exchange(planned_, Trouble::none);
}

void FaultDisk::apply(std::string& bytes, const Write& write) {
  const auto at = static_cast<std::size_t>(write.offset);
  if (write.cuts) return bytes.resize(at);
  if (bytes.size() < at + write.bytes.size()) bytes.resize(at + write.bytes.size());
  std::memcpy(bytes.data() + at, write.bytes.data(), write.bytes.size());
}

void FaultDisk::put(File& file, Write write) {
  apply(file.now, write);
  file.unsynced.push_back(std::move(write));
}

void FaultDisk::cut_power() {
  dead_ = true;
  for (auto& [name, kept] : files_) {
    File& file = *kept;
    for (Write& write : file.unsynced) {
      const double dice = random_.uniform();
      if (dice < 0.4) continue;  // lost, whatever came after it
      if (dice < 0.6 && write.bytes.size() > sector)
        write.bytes.resize(sector * static_cast<std::size_t>(random_.integer(0, static_cast<int>(write.bytes.size() / sector) - 1)));
      apply(file.durable, write);
    }
    file.unsynced.clear();
    file.now = file.durable;
  }
}

void FaultDisk::revive() {
  dead_ = false;
  for (auto& [name, file] : files_) file->shared.clear();
  removed_.clear();
}

FaultDisk::File* FaultDisk::open(const std::string& name, bool create, int& code) {
  const Trouble trouble = turn(Call::open);
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  code = SQLITE_CANTOPEN;
  if (dead_ || trouble != Trouble::none || (!create && !files_.contains(name))) return nullptr;
  code = SQLITE_OK;
  std::unique_ptr<File>& file = files_[name];
  if (!file) file = std::make_unique<File>();
  return file.get();
}

int FaultDisk::read(File& file, void* to, int length, std::int64_t offset) {
  const Trouble trouble = turn(Call::read);
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  if (dead_ || trouble != Trouble::none) return SQLITE_IOERR_READ;
  const auto at = std::min(static_cast<std::size_t>(offset), file.now.size());
  const std::size_t there = std::min(static_cast<std::size_t>(length), file.now.size() - at);
  std::memcpy(to, file.now.data() + at, there);
  if (there == static_cast<std::size_t>(length)) return SQLITE_OK;
  std::memset(static_cast<char*>(to) + there, 0, static_cast<std::size_t>(length) - there);
  return SQLITE_IOERR_SHORT_READ;
}

int FaultDisk::write(File& file, const void* from, int length, std::int64_t offset) {
  const Trouble trouble = turn(Call::write);
  if (dead_) return SQLITE_IOERR_WRITE;
  Write whole{offset, std::string(static_cast<const char*>(from), static_cast<std::size_t>(length)), false};
  if (trouble == Trouble::no_space) return SQLITE_FULL;
  if (trouble == Trouble::io_error) return SQLITE_IOERR_WRITE;
  if (trouble == Trouble::short_write || trouble == Trouble::torn_page) {
    whole.bytes.resize(static_cast<std::size_t>(random_.integer(0, length - 1)) / (trouble == Trouble::torn_page ? sector : 1) *
                       (trouble == Trouble::torn_page ? sector : 1));
    put(file, whole);
    if (trouble == Trouble::short_write) return SQLITE_FULL;  // as SQLite's own file layer says it
    dead_ = true;                                             // torn: the process went with it, the rest of what it wrote stays
    return SQLITE_IOERR_WRITE;
  }
  put(file, std::move(whole));
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  return dead_ ? SQLITE_IOERR_WRITE : SQLITE_OK;
}

int FaultDisk::truncate(File& file, std::int64_t length) {
  const Trouble trouble = turn(Call::truncate);
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  if (dead_ || trouble != Trouble::none) return SQLITE_IOERR_TRUNCATE;
  put(file, {length, {}, true});
  return SQLITE_OK;
}

int FaultDisk::sync(File& file) {
  const Trouble trouble = turn(Call::sync);
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  if (dead_) return SQLITE_IOERR_FSYNC;
  for (const Write& write : file.unsynced)
    if (trouble == Trouble::none || random_.uniform() < 0.5) apply(file.durable, write);
  file.unsynced.clear();
  return trouble == Trouble::none || believes_failed_syncs_ ? SQLITE_OK : code_of_error(Call::sync);
}

int FaultDisk::remove(const std::string& name) {
  const Trouble trouble = turn(Call::remove);
  if (trouble == Trouble::lost_writes) cut_power();
  if (trouble == Trouble::killed) kill();
  if (dead_ || trouble != Trouble::none) return SQLITE_IOERR_DELETE;
  const auto file = files_.find(name);
  if (file == files_.end()) return SQLITE_IOERR_DELETE_NOENT;
  removed_.push_back(std::move(file->second));
  files_.erase(file);
  return SQLITE_OK;
}

void* FaultDisk::shared_memory(File& file, int region, int size) {
  while (static_cast<int>(file.shared.size()) <= region) {
    file.shared.push_back(std::make_unique<char[]>(static_cast<std::size_t>(size)));
    std::memset(file.shared.back().get(), 0, static_cast<std::size_t>(size));
  }
  return file.shared[static_cast<std::size_t>(region)].get();
}

int FaultDisk::random_bytes(char* to, int length) {
  for (int at = 0; at < length; ++at) to[at] = static_cast<char>(random_.bits());
  return length;
}

}  // namespace fracfarm::simulation
