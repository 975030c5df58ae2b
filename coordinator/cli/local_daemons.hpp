// Daemons that a verb starts beside this program and ends again: each in its own process group, none left behind when this program dies.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace fracfarm::cli {

class LocalDaemon {
 public:
  // program: fracfarm-NAME beside this one; its output is appended to `output`.
  LocalDaemon(std::string program, std::vector<std::string> arguments, std::filesystem::path output);
  ~LocalDaemon();  // kills where it still runs
  LocalDaemon(const LocalDaemon&) = delete;
  LocalDaemon& operator=(const LocalDaemon&) = delete;

  Result<void> start();
  bool running();                                             // reaps it where it has ended
  std::optional<int> exit_status() const { return status_; }  // 128 + signal where one ended it
  // SIGTERM, then SIGKILL after grace_s; waits for its end.
  void stop(double grace_s);
  const std::string& program() const { return program_; }
  const std::filesystem::path& output() const { return output_; }

 private:
  std::string program_;
  std::vector<std::string> arguments_;
  std::filesystem::path output_;
  pid_t pid_ = 0;
  std::optional<int> status_;
};

}  // namespace fracfarm::cli
