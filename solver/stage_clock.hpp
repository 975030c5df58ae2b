// Seconds by stage of a step, for reports only: no decision depends on them.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace fracfarm {

template <class Stage, std::size_t count>
class StageClock {
 public:
  void begin() { last_ = std::chrono::steady_clock::now(); }
  // The time since begin or the last end goes to `stage`.
  void end(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    seconds_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  const std::array<double, count>& seconds() const { return seconds_; }

 private:
  std::chrono::steady_clock::time_point last_{};
  std::array<double, count> seconds_{};
};

}  // namespace fracfarm
