// Counts over all outcomes, the worst ones, and how they are told.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tests/robustness/outcome.hpp"

namespace fracfarm::robustness {

class Tally {
 public:
  void add(const Outcome& outcome);

  std::uint64_t runs() const { return runs_; }
  std::uint64_t count(End end) const { return counts_[static_cast<std::size_t>(end)]; }
  std::string counts_text() const;  // "812 FAILED, 120 CENSORED, ..."
  const std::vector<Outcome>& violations() const { return violations_; }

  std::string text(std::uint64_t seed) const;
  nlohmann::ordered_json json(std::uint64_t seed) const;

 private:
  std::uint64_t runs_ = 0, validated_ = 0;
  long long steps_ = 0;
  std::array<std::uint64_t, 5> counts_{};
  std::map<std::string, std::array<std::uint64_t, 5>> by_twist_;
  std::map<std::string, std::uint64_t> numeric_;  // kind of trouble -> runs
  std::map<std::string, std::uint64_t> rules_;    // rule that gave the verdict -> runs
  Outcome slowest_, worst_ledger_;
  std::vector<Outcome> violations_;
};

}  // namespace fracfarm::robustness
