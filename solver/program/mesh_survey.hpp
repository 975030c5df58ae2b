// Meshes of many random patterns: is any of them bad, how many are refused and why, and what one costs.
#pragma once

#include <cstdint>

#include "common/scene/scene.hpp"

namespace fracfarm {

struct MeshSurvey {
  int patterns = 0;
  CrackSet set = CrackSet::orthogonal;
  std::uint64_t seed = 1;       // of the patterns; a pattern's mesh seed is its number
  double element_size = 0.003;  // m
  bool json = false;
};

// Prints the figures. exit_failed where a mesh got through that no gate should pass.
int survey_meshes(const MeshSurvey& survey);

}  // namespace fracfarm
