// Preloaded into the programs of a farm by tests: counts the calls that one of them makes into the system, or only those on certain files,
// and at one of them has trouble, once for each token file: the process is killed, with or without the power, or its disk fails it. A
// program that is started again lives on.
//   FRACFARM_KILL_PROGRAM  its name          FRACFARM_KILL_AT       the number of the call, from 0
//   FRACFARM_KILL_TOKEN    the token file    FRACFARM_KILL_FILES    part of the paths of the files that count; empty: every call counts
//   FRACFARM_KILL_TROUBLE  SIGKILL (also where it is empty), ENOSPC, EIO, short write, lost unsynced writes
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace {

enum class Trouble { killed, no_space, io_error, short_write, lost_writes };
enum class Call { other, read, write, change };  // change: of a file's name, length or state on the disk

std::atomic<long> calls{0};
long trouble_at = -1;
Trouble trouble = Trouble::killed;
const char* token = "";  // plain text: the first calls come before the constructors of objects
const char* files = "";
bool some_files = false;
std::atomic<bool> full_after_short{false};

// --- what a loss of power takes: bytes and names that were not synced ---

struct Renamed {
  std::string from, to, before;  // a second name of what `to` was, or empty
};
std::mutex unsynced_mutex;
std::map<std::string, off_t>& unsynced() {  // path -> its length when it was last synced
  static auto* all = new std::map<std::string, off_t>;
  return *all;
}
std::vector<Renamed>& renamed() {
  static auto* all = new std::vector<Renamed>;
  return *all;
}

std::string path_of(int fd) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t length = ::readlink(link, path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

bool counts(const std::string& path) { return some_files && path.find(files) != std::string::npos; }

void note_write(int fd) {
  struct stat info {};
  if (trouble != Trouble::lost_writes || trouble_at < 0 || ::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) return;
  const std::lock_guard lock(unsynced_mutex);
  unsynced().try_emplace(path_of(fd), info.st_size);
}

void note_sync(int fd) {
  if (trouble != Trouble::lost_writes || trouble_at < 0) return;
  const std::lock_guard lock(unsynced_mutex);
  const std::string path = path_of(fd);
  unsynced().erase(path);
  std::erase_if(renamed(), [&](const Renamed& it) {
    const bool here = it.to.substr(0, it.to.rfind('/')) == path;
    if (here && !it.before.empty()) ::unlink(it.before.c_str());
    return here;
  });
}

void note_rename(const std::string& from, const std::string& to) {
  if (trouble != Trouble::lost_writes || trouble_at < 0) return;
  const std::lock_guard lock(unsynced_mutex);
  std::string before = to + ".before";
  if (::link(to.c_str(), before.c_str()) != 0) before.clear();
  renamed().push_back({from, to, before});
  if (auto it = unsynced().extract(from)) it.key() = to, unsynced().insert(std::move(it));
}

void lose_unsynced() {
  const std::lock_guard lock(unsynced_mutex);
  for (const auto& [path, length] : unsynced()) (void)!::truncate(path.c_str(), length);
  for (auto it = renamed().rbegin(); it != renamed().rend(); ++it) {
    ::unlink(it->to.c_str());
    if (!it->before.empty()) ::link(it->before.c_str(), it->to.c_str()), ::unlink(it->before.c_str());
  }
}

// --- when ---

Trouble trouble_named(const std::string& text) {
  return text == "ENOSPC"                 ? Trouble::no_space
         : text == "EIO"                  ? Trouble::io_error
         : text == "short write"          ? Trouble::short_write
         : text == "lost unsynced writes" ? Trouble::lost_writes
                                          : Trouble::killed;
}

const char* environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

__attribute__((constructor)) void begin() {
  char self[4096] = "";
  if (::readlink("/proc/self/exe", self, sizeof self - 1) < 0) return;
  const char* name = std::strrchr(self, '/');
  if (!name || std::strcmp(environment("FRACFARM_KILL_PROGRAM"), name + 1) != 0) return;
  token = environment("FRACFARM_KILL_TOKEN");
  files = environment("FRACFARM_KILL_FILES");
  some_files = *files != 0;
  trouble = trouble_named(environment("FRACFARM_KILL_TROUBLE"));
  trouble_at = std::atol(environment("FRACFARM_KILL_AT"));
}

bool may_have(Call call) {
  switch (trouble) {
    case Trouble::no_space:
      return call == Call::write || call == Call::change;
    case Trouble::short_write:
      return call == Call::write;
    case Trouble::io_error:
      return call != Call::other;
    case Trouble::killed:
    case Trouble::lost_writes:
      break;
  }
  return true;
}

// True where this call is to fail; does not come back where the process is to die.
bool due(Call call, const std::string& path) {
  if (trouble_at < 0 || !may_have(call) || (some_files && !counts(path))) return false;
  if (calls.fetch_add(1) != trouble_at || ::unlink(token) != 0) return false;
  if (trouble == Trouble::lost_writes) lose_unsynced();
  if (trouble == Trouble::lost_writes || trouble == Trouble::killed) ::kill(::getpid(), SIGKILL);
  return true;
}

int fail() { return errno = trouble == Trouble::io_error ? EIO : ENOSPC, -1; }

std::string path_if_needed(int fd) { return trouble_at >= 0 && some_files ? path_of(fd) : std::string(); }

template <class Function>
Function* real(Function* own, const char* name) {
  (void)own;
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// Half of it, and the disk is full when the rest is to be written.
template <class Write>
ssize_t put(int fd, std::size_t n, const Write& write) {
  const std::string path = path_if_needed(fd);
  if (full_after_short && counts(path) && full_after_short.exchange(false)) return fail();
  note_write(fd);
  if (!due(Call::write, path)) return write(n);
  if (trouble != Trouble::short_write || n < 2) return fail();
  full_after_short = true;
  return write(n / 2);
}

template <class Do>
int change(int fd, const Do& what) {
  return due(Call::change, path_if_needed(fd)) ? fail() : what();
}

bool needs_mode(int flags) { return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE; }
bool refused(const char* path, int flags) { return some_files && (flags & O_CREAT) != 0 && due(Call::change, path); }

}  // namespace

#define REAL(name) static auto* const own = real(&::name, #name);

extern "C" {

ssize_t read(int fd, void* to, size_t n) {
  REAL(read)
  return due(Call::read, path_if_needed(fd)) ? fail() : own(fd, to, n);
}
ssize_t pread(int fd, void* to, size_t n, off_t at) {
  REAL(pread)
  return due(Call::read, path_if_needed(fd)) ? fail() : own(fd, to, n, at);
}
ssize_t pread64(int fd, void* to, size_t n, off64_t at) {
  REAL(pread64)
  return due(Call::read, path_if_needed(fd)) ? fail() : own(fd, to, n, at);
}
ssize_t write(int fd, const void* from, size_t n) {
  REAL(write)
  return put(fd, n, [&](size_t length) { return own(fd, from, length); });
}
ssize_t pwrite(int fd, const void* from, size_t n, off_t at) {
  REAL(pwrite)
  return put(fd, n, [&](size_t length) { return own(fd, from, length, at); });
}
ssize_t pwrite64(int fd, const void* from, size_t n, off64_t at) {
  REAL(pwrite64)
  return put(fd, n, [&](size_t length) { return own(fd, from, length, at); });
}
int fsync(int fd) {
  REAL(fsync)
  const int answer = change(fd, [&] { return own(fd); });
  if (answer == 0) note_sync(fd);
  return answer;
}
int fdatasync(int fd) {
  REAL(fdatasync)
  const int answer = change(fd, [&] { return own(fd); });
  if (answer == 0) note_sync(fd);
  return answer;
}
int ftruncate(int fd, off_t n) noexcept {
  REAL(ftruncate)
  note_write(fd);
  return change(fd, [&] { return own(fd, n); });
}
int ftruncate64(int fd, off64_t n) noexcept {
  REAL(ftruncate64)
  note_write(fd);
  return change(fd, [&] { return own(fd, n); });
}
int rename(const char* from, const char* to) noexcept {
  REAL(rename)
  if (due(Call::change, to)) return fail();
  note_rename(from, to);
  return own(from, to);
}
int open(const char* path, int flags, ...) {
  REAL(open)
  va_list more;
  va_start(more, flags);
  const mode_t mode = needs_mode(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  return refused(path, flags) ? fail() : own(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  REAL(open64)
  va_list more;
  va_start(more, flags);
  const mode_t mode = needs_mode(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  return refused(path, flags) ? fail() : own(path, flags, mode);
}
int close(int fd) {
  REAL(close)
  (void)due(Call::other, path_if_needed(fd));
  return own(fd);
}
int poll(struct pollfd* all, nfds_t n, int ms) {
  REAL(poll)
  (void)due(Call::other, "");
  return own(all, n, ms);
}

}  // extern "C"
