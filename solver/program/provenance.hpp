// Where a record comes from: build, machine, libraries, costs. For people and audits; nothing reads it back to decide.
#pragma once

#include <map>
#include <string>

#include "solver/solve.hpp"

namespace fracfarm {

struct AttemptInfo {
  int attempt = 1;
  double step_scale = 1.0;
};

std::map<std::string, std::string> provenance_of(const Scene& scene, const RunResult& result, const AttemptInfo& attempt);

}  // namespace fracfarm
