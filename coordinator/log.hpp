// The coordinator's log: JSON lines in FARM/log/coordinator.jsonl, short lines on stderr.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace spdlog {
class logger;
}

namespace fracfarm {

class CoordinatorLog {
 public:
  enum class Level { info, warning, error };
  CoordinatorLog(const std::filesystem::path& folder, bool quiet);
  ~CoordinatorLog();
  void say(Level level, std::string_view text);

 private:
  std::shared_ptr<spdlog::logger> file_;
  bool quiet_;
};

}  // namespace fracfarm
