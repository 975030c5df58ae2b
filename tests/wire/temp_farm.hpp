// A farm folder of its own for one test, removed at its end.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace fracfarm {

struct TempFarm {
  std::filesystem::path path;
  TempFarm() {
    static std::atomic<int> count{0};
    path = std::filesystem::temp_directory_path() / ("fracfarm-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  ~TempFarm() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TempFarm(const TempFarm&) = delete;
  TempFarm& operator=(const TempFarm&) = delete;
};

}  // namespace fracfarm
