// Preloaded into the programs of a farm by tests: counts the calls that one of them makes into the system and kills it at one of them, once
// for each token file, so that the program that is started again lives on.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};
long kill_at = -1;
const char* token = nullptr;

__attribute__((constructor)) void begin() {
  const char* program = std::getenv("FRACFARM_KILL_PROGRAM");
  const char* at = std::getenv("FRACFARM_KILL_AT");
  char self[4096] = "";
  if (!program || !at || ::readlink("/proc/self/exe", self, sizeof self - 1) < 0) return;
  const char* name = std::strrchr(self, '/');
  if (!name || std::strcmp(name + 1, program) != 0) return;
  token = std::getenv("FRACFARM_KILL_TOKEN");
  kill_at = std::atol(at);
}

void count() {
  if (kill_at < 0 || calls.fetch_add(1) != kill_at) return;
  if (token && ::unlink(token) == 0) ::kill(::getpid(), SIGKILL);
}

template <class Function>
Function* real(Function* own, const char* name) {
  (void)own;
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

#define COUNTED(name, ...)                       \
  static auto* const own = real(&::name, #name); \
  count();                                       \
  return own(__VA_ARGS__)

extern "C" {

ssize_t read(int fd, void* to, size_t n) { COUNTED(read, fd, to, n); }
ssize_t write(int fd, const void* from, size_t n) { COUNTED(write, fd, from, n); }
ssize_t pread(int fd, void* to, size_t n, off_t at) { COUNTED(pread, fd, to, n, at); }
ssize_t pwrite(int fd, const void* from, size_t n, off_t at) { COUNTED(pwrite, fd, from, n, at); }
ssize_t pread64(int fd, void* to, size_t n, off64_t at) { COUNTED(pread64, fd, to, n, at); }
ssize_t pwrite64(int fd, const void* from, size_t n, off64_t at) { COUNTED(pwrite64, fd, from, n, at); }
int fsync(int fd) { COUNTED(fsync, fd); }
int fdatasync(int fd) { COUNTED(fdatasync, fd); }
int ftruncate(int fd, off_t n) noexcept { COUNTED(ftruncate, fd, n); }
int ftruncate64(int fd, off64_t n) noexcept { COUNTED(ftruncate64, fd, n); }
int rename(const char* from, const char* to) noexcept { COUNTED(rename, from, to); }
int close(int fd) { COUNTED(close, fd); }
int poll(struct pollfd* all, nfds_t n, int ms) { COUNTED(poll, all, n, ms); }

}  // extern "C"
