#include "tests/robustness/pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "common/base/clock.hpp"

namespace fracfarm::robustness {
namespace {

struct Child {
  pid_t pid = -1;
  int ask = -1, answer = -1;  // our ends of its pipes
  std::uint64_t number = 0;
  double since_s = 0.0;
  std::string heard;
};

bool read_exactly(int file, void* into, std::size_t size) {
  auto* at = static_cast<char*>(into);
  while (size > 0) {
    const ssize_t got = ::read(file, at, size);
    if (got <= 0) return false;
    at += got, size -= static_cast<std::size_t>(got);
  }
  return true;
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = ::write(file, text.data() + done, text.size() - done);
    if (wrote <= 0) return;
    done += static_cast<std::size_t>(wrote);
  }
}

// A scene that asks for more is a find, not a reason to push the machine over. The sanitizers reserve far more than they use.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__)
  constexpr rlim_t most = rlim_t{4} << 30;
  const struct rlimit limit { most, most };
  ::setrlimit(RLIMIT_AS, &limit);
#endif
  const struct rlimit no_core { 0, 0 };
  ::setrlimit(RLIMIT_CORE, &no_core);
}

// Ends without the destructors and buffers of the parent's copy.
[[noreturn]] void serve(int ask, int answer, const std::function<std::string(std::uint64_t)>& work) {
  limit_memory();
  std::uint64_t number = 0;
  while (read_exactly(ask, &number, sizeof number)) write_all(answer, work(number));
  ::_exit(0);
}

class Pool {
 public:
  using Work = std::function<std::string(std::uint64_t)>;
  Pool(const PoolSettings& settings, const Work& work) : settings_(settings), work_(work), next_(settings.first) {
    std::signal(SIGPIPE, SIG_IGN);
    children_.reserve(static_cast<std::size_t>(settings.jobs));
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(static_cast<std::uint64_t>(settings.jobs), settings.count); ++k)
      start(children_.emplace_back());
  }

  template <class Answered, class Lost>
  void run(const Answered& answered, const Lost& lost) {
    while (!children_.empty()) {
      wait_for_news();
      for (Child& child : children_) {
        const bool closed = !hear(child);
        if (const auto end = child.heard.find('\n'); end != std::string::npos) {
          answered(child.heard.substr(0, end));
          child.heard.clear();
          if (!ask_next(child)) dismiss(child);
        } else if (closed || clock_.monotonic_s() - child.since_s > settings_.limit_s) {
          lost(child.number, how_it_ended(child, closed));
          replace(child);
        }
      }
      std::erase_if(children_, [](const Child& child) { return child.pid < 0; });
    }
  }

 private:
  void start(Child& child) {
    int ask[2], answer[2];
    if (::pipe(ask) != 0 || ::pipe(answer) != 0) throw std::runtime_error("no pipe");
    std::fflush(nullptr);
    child.pid = ::fork();
    if (child.pid < 0) throw std::runtime_error("no child process");
    if (child.pid == 0) {
      for (const Child& other : children_)
        if (&other != &child) ::close(other.ask), ::close(other.answer);
      ::close(ask[1]), ::close(answer[0]);
      serve(ask[0], answer[1], work_);
    }
    ::close(ask[0]), ::close(answer[1]);
    child.ask = ask[1], child.answer = answer[0];
    child.heard.clear();
    ask_next(child);
  }

  bool ask_next(Child& child) {
    if (next_ >= settings_.first + settings_.count) return false;
    child.number = next_++;
    child.since_s = clock_.monotonic_s();
    return ::write(child.ask, &child.number, sizeof child.number) == sizeof child.number;
  }

  void dismiss(Child& child) {
    ::close(child.ask), ::close(child.answer);
    ::waitpid(child.pid, nullptr, 0);
    child.pid = child.ask = child.answer = -1;
  }

  void replace(Child& child) {
    ::close(child.ask), ::close(child.answer);
    child.pid = child.ask = child.answer = -1;
    if (next_ < settings_.first + settings_.count) start(child);
  }

  std::string how_it_ended(Child& child, bool closed) {
    if (!closed) ::kill(child.pid, SIGKILL);
    int status = 0;
    ::waitpid(child.pid, &status, 0);
    if (!closed) return fmt::format("hung: no answer within {} s", settings_.limit_s);
    if (WIFSIGNALED(status)) return fmt::format("died of signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("died with status {}", WEXITSTATUS(status));
  }

  void wait_for_news() {
    std::vector<pollfd> files;
    for (const Child& child : children_) files.push_back({child.answer, POLLIN, 0});
    ::poll(files.data(), files.size(), 200);
  }

  // Takes in what there is; false where the child has closed its end.
  bool hear(Child& child) {
    pollfd file{child.answer, POLLIN, 0};
    while (::poll(&file, 1, 0) > 0) {
      char buffer[4096];
      const ssize_t got = ::read(child.answer, buffer, sizeof buffer);
      if (got <= 0) return false;
      child.heard.append(buffer, static_cast<std::size_t>(got));
      if (child.heard.back() == '\n') return true;
    }
    return true;
  }

  const PoolSettings& settings_;
  const Work& work_;
  SystemClock clock_;
  std::uint64_t next_;
  std::vector<Child> children_;
};

}  // namespace

void run_pool(const PoolSettings& settings, const std::function<std::string(std::uint64_t)>& work,
              const std::function<void(const std::string& line)>& answered,
              const std::function<void(std::uint64_t number, const std::string& why)>& lost) {
  Pool(settings, work).run(answered, lost);
}

}  // namespace fracfarm::robustness
