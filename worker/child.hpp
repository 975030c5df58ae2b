// A solver child: its own process group, killed by the kernel when its worker dies, limited in memory and CPU time, three pipes that never
// block. It knows nothing of tasks and reports; slot.hpp does.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace fracfarm::worker {

struct ChildOptions {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::uint64_t memory_limit = 0;  // bytes of address space, 0: none
};

// How a child ended.
struct ChildEnd {
  int status = 0;              // as waitpid gives it
  std::uint64_t peak_rss = 0;  // bytes
};

class Child {
 public:
  // To be called from the main thread only: the kernel ties "kill it when its parent dies" to the thread that forked.
  // Errors: NODE_LOST where no process can be made or the program cannot be run, with the reason in words.
  static Result<Child> spawn(const ChildOptions& options);
  ~Child();  // kills the group and waits
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;

  pid_t pid() const { return pid_; }
  int output() const { return output_; }  // for poll(2)
  int errors() const { return errors_; }

  // Queues text for the child's input and writes what fits; false where the child reads no more.
  bool write(std::string_view text);
  bool flush();
  bool writing() const { return !unwritten_.empty(); }
  int input() const { return input_; }
  void close_input();

  // What has come since: complete lines of output without their newline; `overlong` where a line passes max_line.
  std::vector<std::string> read_lines(bool& overlong);
  void read_errors();
  const std::string& last_words() const { return last_words_; }  // the end of its error output
  void forget_last_words() { last_words_.clear(); }

  void signal(int number);          // to the child alone
  void kill_group();                // SIGKILL to all of its group
  void limit_cpu(double more_s);    // from now on; SIGXCPU beyond
  std::optional<ChildEnd> ended();  // never blocks; gives the end once

  static constexpr std::size_t max_line = 1u << 20;

 private:
  Child() = default;
  void close_all();

  pid_t pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
  std::string unwritten_;
  std::string partial_;  // an output line that has not ended
  std::string last_words_;
};

}  // namespace fracfarm::worker
