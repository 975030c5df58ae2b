#include "worker/child_end.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <cstring>
#include <fstream>

namespace fracfarm::worker {
namespace {

constexpr double near_the_limit = 0.9;  // of the memory limit: a SIGKILL there is the limit's

bool says(const std::string& words, std::string_view what) { return words.find(what) != std::string::npos; }

std::string signal_name(int number) {
  const char* name = ::sigabbrev_np(number);
  return name ? fmt::format("SIG{}", name) : fmt::format("signal {}", number);
}

// The last line that is not empty, for the message.
std::string last_line(const std::string& words) {
  const std::size_t end = words.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return {};
  const std::size_t begin = words.find_last_of('\n', end);
  return words.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

std::string with_words(std::string message, const std::string& words) {
  const std::string line = last_line(words);
  return line.empty() ? message : fmt::format("{}; its last words: {}", message, line);
}

bool out_of_memory(const EndEvidence& end, int signal) {
  if (says(end.last_words, "bad_alloc") || says(end.last_words, "Cannot allocate memory")) return true;
  const bool at_limit = end.memory_limit > 0 && static_cast<double>(end.peak_rss) > near_the_limit * static_cast<double>(end.memory_limit);
  return signal == SIGKILL && (end.oom_kill_counted || at_limit);
}

}  // namespace

Classified classify(const EndEvidence& end) {
  switch (end.killed) {
    case Killed::hang:
      return {Fault::solver_crash, with_words("the solver hung: no sign of progress", end.last_words), "hang"};
    case Killed::wall_budget:
      return {Fault::solver_crash, with_words("the solver did not end at its wall budget and was killed", end.last_words), "wall_budget"};
    case Killed::unreadable:
      return {Fault::solver_crash, with_words("the solver's report cannot be read", end.last_words), "unreadable report"};
    case Killed::grace:
    case Killed::abandoned:
      return {Fault::planned_stop, "stopped", "stopped"};
    case Killed::no:
      break;
  }
  const int signal = WIFSIGNALED(end.status) ? WTERMSIG(end.status) : 0;
  if (out_of_memory(end, signal))
    return {Fault::out_of_memory, with_words(fmt::format("out of memory at a peak of {} MB", end.peak_rss / 1'000'000), end.last_words),
            "memory"};
  if (signal == SIGBUS)
    return {Fault::node_lost, with_words("bus error: a file or memory of this node went away", end.last_words), "SIGBUS"};
  if (signal != 0)
    return {Fault::solver_crash, with_words(fmt::format("the solver ended by {}", signal_name(signal)), end.last_words),
            signal_name(signal)};
  const int status = WEXITSTATUS(end.status);
  if (status == 127 && says(end.last_words, "shared libraries"))
    return {Fault::node_lost, with_words("the solver cannot start", end.last_words), "missing library"};
  const std::string ended = status == 0 ? "the solver ended without a report" : fmt::format("the solver ended with status {}", status);
  return {Fault::solver_crash, with_words(ended, end.last_words), fmt::format("exit {}", status)};
}

std::uint64_t memory_kills() {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::")) continue;
    std::ifstream events("/sys/fs/cgroup" + line.substr(3) + "/memory.events");
    std::string name;
    for (std::uint64_t count = 0; events >> name >> count;)
      if (name == "oom_kill") return count;
  }
  return 0;
}

}  // namespace fracfarm::worker
