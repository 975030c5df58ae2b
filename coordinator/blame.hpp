// Whom a fault is held against. A failure of a job that another node then did is the node's: enough of them and the node is suspect, and
// proves itself on a canary, a job whose result is known, before it gets work again.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "common/base/fault.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {

inline constexpr std::uint64_t blames_of_a_suspect = 3;
inline constexpr std::uint64_t results_to_forget = 50;  // of a node in a row: what was held against it is no more
inline constexpr double first_canary_pause_s = 60.0;    // after one that failed, doubling
inline constexpr double longest_canary_pause_s = 3600.0;

// Nodes whose failures a result on `node` proves to be theirs, each once.
inline std::vector<std::string> blamed_nodes(std::span<const AttemptRow> history, const std::string& node) {
  std::vector<std::string> blamed;
  for (const AttemptRow& row : history) {
    const bool suspected = fault_row(*fault_by_name(row.fault)).node_suspected;
    if (suspected && !row.node.empty() && row.node != node && std::find(blamed.begin(), blamed.end(), row.node) == blamed.end())
      blamed.push_back(row.node);
  }
  return blamed;
}

inline double canary_pause_s(int failed) {
  return std::min(longest_canary_pause_s, first_canary_pause_s * std::exp2(std::clamp(failed - 1, 0, 20)));
}

}  // namespace fracfarm
