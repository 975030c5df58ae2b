// What a worker says: JSON lines in FARM/log/<name>.jsonl (rotated), short lines on stderr unless quiet.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "worker/session.hpp"

namespace spdlog {
class logger;
}

namespace fracfarm::worker {

class Log {
 public:
  Log(const std::filesystem::path& farm, const std::string& name, bool quiet);
  ~Log();
  void say(Say::Level level, std::string_view text);
  // Only to the file, about one job: {"job": 12, "event": "started"}.
  void job(std::uint64_t job, std::string_view event, std::string_view detail = {});

 private:
  std::string name_;
  bool quiet_;
  std::shared_ptr<spdlog::logger> file_;  // null where the folder cannot be written: the farm goes on without a log
};

}  // namespace fracfarm::worker
