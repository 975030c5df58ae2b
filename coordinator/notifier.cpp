#include "coordinator/notifier.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/clock.hpp"

extern char** environ;

namespace fracfarm {
namespace {

constexpr std::size_t most_waiting = 1000;  // then the oldest are dropped, and it is said

struct Child {
  pid_t pid = -1;
  int input = -1;
};

// In a process group of its own, so that what it starts ends with it.
Child start(const std::string& command) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return {};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe[0], 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t none, pipes;
  ::sigemptyset(&none);
  ::sigemptyset(&pipes);
  ::sigaddset(&pipes, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &pipes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string shell = "/bin/sh", flag = "-c", text = command;
  std::array<char*, 4> words{shell.data(), flag.data(), text.data(), nullptr};
  Child child{-1, pipe[1]};
  if (::posix_spawn(&child.pid, shell.c_str(), &actions, &attributes, words.data(), environ) != 0) child.pid = -1;
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(pipe[0]);
  return child;
}

// Its wait status; nothing where it was killed for taking too long.
std::optional<int> await(pid_t pid, double patience_s) {
  const auto last = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  int status = 0;
  while (::waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > last) {
      ::kill(-pid, SIGKILL);
      ::waitpid(pid, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return status;
}

}  // namespace

std::string notice_json(const Notice& it, double wall_s) {
  nlohmann::json body{{"schema", "fracfarm.notice/1"}, {"kind", it.kind}, {"text", it.text}, {"at", utc_text(wall_s)}};
  if (it.job) body["job"] = it.job;
  if (!it.node.empty()) body["node"] = it.node;
  return body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Notifier::Notifier(std::string command, double patience_s) : command_(std::move(command)), patience_s_(patience_s) {
  if (!command_.empty()) thread_ = std::thread([this] { serve(); });
}

Notifier::~Notifier() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    closing_ = true;
  }
  more_.notify_one();
  thread_.join();
}

void Notifier::tell(const std::vector<Notice>& notices, double wall_s) {
  if (command_.empty() || notices.empty()) return;
  const std::scoped_lock lock(mutex_);
  for (const Notice& it : notices) waiting_.push_back(notice_json(it, wall_s));
  if (waiting_.size() > most_waiting) {
    complaints_.push_back(fmt::format("{} notices were dropped: the notify command is too slow", waiting_.size() - most_waiting));
    waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(most_waiting));
  }
  more_.notify_one();
}

std::vector<std::string> Notifier::take_complaints() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(complaints_, {});
}

// A command that reads nothing may have ended before it is written to: that is no reason for this program to end.
void Notifier::serve() {
  sigset_t pipes;
  ::sigemptyset(&pipes);
  ::sigaddset(&pipes, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &pipes, nullptr);
  const auto never = std::chrono::steady_clock::time_point::max();
  auto last = never;
  for (;;) {
    std::string text;
    {
      std::unique_lock lock(mutex_);
      more_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
      if (closing_ && last == never)
        last = std::chrono::steady_clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * patience_s_));
      if (waiting_.empty() || (closing_ && std::chrono::steady_clock::now() > last)) return;
      text = std::move(waiting_.front());
      waiting_.pop_front();
    }
    run(text);
  }
}

// A notice is smaller than a pipe's buffer, so writing it waits for nobody.
void Notifier::run(const std::string& text) {
  const Child child = start(command_);
  std::string complaint;
  if (child.pid < 0) {
    complaint = "the notify command could not be started";
  } else {
    const std::string line = text.substr(0, 8000) + "\n";
    (void)!::write(child.input, line.data(), line.size());
  }
  if (child.input >= 0) ::close(child.input);
  if (child.pid >= 0) {
    const std::optional<int> status = await(child.pid, patience_s_);
    if (!status)
      complaint = fmt::format("the notify command took more than {:.0f} s and was killed", patience_s_);
    else if (*status != 0)
      complaint =
          fmt::format("the notify command ended with status {}", WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status));
  }
  if (complaint.empty()) return;
  const std::scoped_lock lock(mutex_);
  complaints_.push_back(std::move(complaint));
}

}  // namespace fracfarm
