// Child processes that answer one number at a time with one line. A child that dies or answers too late is an answer, too, and is replaced:
// whatever a trial does, the command goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace fracfarm::robustness {

struct PoolSettings {
  std::uint64_t first = 0, count = 0;  // numbers to ask for
  int jobs = 1;                        // children at once
  double limit_s = 20.0;               // for one answer; a child that takes longer is killed
};

// `work` runs in a child and returns a line that ends with its only line break. `answered` and `lost` run in the caller, in no order of
// numbers; `why` of a lost one says the signal, the exit status or the time.
void run_pool(const PoolSettings& settings, const std::function<std::string(std::uint64_t)>& work,
              const std::function<void(const std::string& line)>& answered,
              const std::function<void(std::uint64_t number, const std::string& why)>& lost);

}  // namespace fracfarm::robustness
