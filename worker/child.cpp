#include "worker/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <thread>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr std::size_t last_words_limit = 4096;

// Two ends of a pipe, both closed on exec and by the destructor unless taken.
struct Pipe {
  int read_end = -1;
  int write_end = -1;
  bool open() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return false;
    read_end = ends[0];
    write_end = ends[1];
    return true;
  }
  ~Pipe() {
    if (read_end >= 0) ::close(read_end);
    if (write_end >= 0) ::close(write_end);
  }
};

void never_block(int fd) { ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK); }

// Between fork and exec: only async-signal-safe calls. Ends by exec, or by telling errno through `trouble`.
[[noreturn]] void become(const ChildOptions& options, char* const* arguments, pid_t parent, const Pipe& in, const Pipe& out,
                         const Pipe& err, int trouble) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before the line above
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGPIPE, SIGTERM, SIGINT, SIGUSR1, SIGCHLD}) ::signal(number, SIG_DFL);
  if (options.memory_limit > 0) {
    const rlimit limit{options.memory_limit, options.memory_limit};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::dup2(in.read_end, STDIN_FILENO);
  ::dup2(out.write_end, STDOUT_FILENO);
  ::dup2(err.write_end, STDERR_FILENO);
  ::execv(arguments[0], arguments);
  const int reason = errno;
  (void)!::write(trouble, &reason, sizeof reason);
  ::_exit(127);
}

}  // namespace

Result<Child> Child::spawn(const ChildOptions& options) {
  Pipe in, out, err, trouble;
  if (!in.open() || !out.open() || !err.open() || !trouble.open())
    return fail(Fault::node_lost, fmt::format("cannot make pipes for {}: {}", options.program.string(), std::strerror(errno)));
  std::vector<std::string> words{options.program.string()};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) return fail(Fault::node_lost, fmt::format("cannot start {}: {}", options.program.string(), std::strerror(errno)));
  if (pid == 0) become(options, arguments.data(), parent, in, out, err, trouble.write_end);
  ::setpgid(pid, pid);  // here too: whoever comes first
  Child child;
  child.pid_ = pid;
  ::close(std::exchange(trouble.write_end, -1));
  int reason = 0;
  if (::read(trouble.read_end, &reason, sizeof reason) == sizeof reason)
    return fail(Fault::node_lost, fmt::format("cannot run {}: {}", options.program.string(), std::strerror(reason)));
  child.input_ = std::exchange(in.write_end, -1);
  child.output_ = std::exchange(out.read_end, -1);
  child.errors_ = std::exchange(err.read_end, -1);
  for (const int fd : {child.input_, child.output_, child.errors_}) never_block(fd);
  return child;
}

Child::~Child() {
  if (pid_ > 0) {
    kill_group();
    ::waitpid(pid_, nullptr, 0);
  }
  close_all();
}

Child::Child(Child&& other) noexcept { *this = std::move(other); }

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(input_, other.input_);
  std::swap(output_, other.output_);
  std::swap(errors_, other.errors_);
  std::swap(unwritten_, other.unwritten_);
  std::swap(partial_, other.partial_);
  std::swap(last_words_, other.last_words_);
  return *this;
}

void Child::close_all() {
  for (int* fd : {&input_, &output_, &errors_})
    if (*fd >= 0) ::close(std::exchange(*fd, -1));
}

bool Child::write(std::string_view text) {
  unwritten_ += text;
  return flush();
}

bool Child::flush() {
  while (!unwritten_.empty() && input_ >= 0) {
    const ssize_t wrote = ::write(input_, unwritten_.data(), unwritten_.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return errno == EAGAIN;
    unwritten_.erase(0, static_cast<std::size_t>(wrote));
  }
  return input_ >= 0;
}

void Child::close_input() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
}

std::vector<std::string> Child::read_lines(bool& overlong) {
  std::vector<std::string> lines;
  std::array<char, 1 << 16> buffer;
  while (output_ >= 0) {
    const ssize_t got = ::read(output_, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) break;
    if (got <= 0) {
      ::close(std::exchange(output_, -1));
      break;
    }
    std::string_view text(buffer.data(), static_cast<std::size_t>(got));
    for (std::size_t at; (at = text.find('\n')) != std::string_view::npos; text.remove_prefix(at + 1)) {
      lines.push_back(std::exchange(partial_, {}).append(text.substr(0, at)));
    }
    partial_ += text;
    overlong = partial_.size() > max_line || lines.size() > 1000;
    if (overlong) break;
  }
  return lines;
}

void Child::read_errors() {
  std::array<char, 4096> buffer;
  for (int rounds = 0; errors_ >= 0 && rounds < 64; ++rounds) {
    const ssize_t got = ::read(errors_, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return;
    if (got <= 0) {
      ::close(std::exchange(errors_, -1));
      return;
    }
    last_words_.append(buffer.data(), static_cast<std::size_t>(got));
    if (last_words_.size() > last_words_limit) last_words_.erase(0, last_words_.size() - last_words_limit);
  }
}

void Child::signal(int number) {
  if (pid_ > 0) ::kill(pid_, number);
}

void Child::kill_group() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);  // where it had not made its group yet
}

void Child::limit_cpu(double more_s) {
  clockid_t clock;
  timespec used{};
  if (pid_ <= 0 || ::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return;
  const double threads = std::max(1u, std::thread::hardware_concurrency());
  const double limit = static_cast<double>(used.tv_sec) + 1.0 + threads * more_s;
  rlimit cpu{RLIM_INFINITY, RLIM_INFINITY};
  if (limit < 1e15) cpu.rlim_cur = static_cast<rlim_t>(limit);
  ::prlimit(pid_, RLIMIT_CPU, &cpu, nullptr);
}

std::optional<ChildEnd> Child::ended() {
  if (pid_ <= 0) return std::nullopt;
  ChildEnd end;
  rusage usage{};
  const pid_t got = ::wait4(pid_, &end.status, WNOHANG, &usage);
  if (got != pid_) return std::nullopt;
  end.peak_rss = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  ::kill(-pid_, SIGKILL);  // whatever it left behind in its group
  pid_ = -1;
  return end;
}

}  // namespace fracfarm::worker
