#include "coordinator/cli/local_daemons.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "common/base/clock.hpp"

namespace fracfarm::cli {
namespace {

// Only calls that are safe between fork and exec.
[[noreturn]] void become(const char* program, char** arguments, int output, pid_t parent) {
  ::setpgid(0, 0);  // Ctrl-C is for the verb alone: it ends its daemons in order
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(127);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  const int input = ::open("/dev/null", O_RDONLY);
  if (input >= 0) ::dup2(input, STDIN_FILENO);
  ::execv(program, arguments);
  ::_exit(127);
}

}  // namespace

LocalDaemon::LocalDaemon(std::string program, std::vector<std::string> arguments, std::filesystem::path output)
    : program_(std::move(program)), arguments_(std::move(arguments)), output_(std::move(output)) {}

LocalDaemon::~LocalDaemon() {
  if (running()) stop(5.0);
}

Result<void> LocalDaemon::start() {
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / program_;
  if (::access(path.c_str(), X_OK) != 0)
    return fail(Fault::node_lost, fmt::format("cannot run {}: {}", path.string(), std::strerror(errno)));
  const int output = ::open(output_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (output < 0) return fail(Fault::node_lost, fmt::format("cannot write {}: {}", output_.string(), std::strerror(errno)));
  std::vector<std::string> words{path.string()};
  words.insert(words.end(), arguments_.begin(), arguments_.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  status_.reset();
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(path.c_str(), pointers.data(), output, parent);
  ::close(output);
  if (pid_ < 0) return fail(Fault::node_lost, fmt::format("cannot start {}: {}", path.string(), std::strerror(errno)));
  return {};
}

bool LocalDaemon::running() {
  if (pid_ <= 0 || status_) return false;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return true;
  status_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return false;
}

void LocalDaemon::stop(double grace_s) {
  if (!running()) return;
  ::kill(pid_, SIGTERM);
  SystemClock clock;
  const double last_s = clock.monotonic_s() + grace_s;
  while (running() && clock.monotonic_s() < last_s) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (!running()) return;
  ::kill(-pid_, SIGKILL);
  while (running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace fracfarm::cli
