// What every accepted run must satisfy, worked out from the result alone with none of the project's criteria: a table of rules.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "solver/solve.hpp"

namespace fracfarm::robustness {

struct AcceptanceRule {
  std::string_view name;
  std::string (*broken)(const Scene& scene, const RunResult& result);  // in words; empty where it holds
};

std::span<const AcceptanceRule> acceptance_rules();  // of runs on a grid; accepted_mesh.hpp has those of a mesh

// The first broken rule, "name: words"; empty where all hold.
std::string broken_rule(const Scene& scene, const RunResult& result);

// Largest residual of the ledger, summed here again, over the largest work or energy; 0 where there is no energy.
double ledger_share(const RunResult& result);

}  // namespace fracfarm::robustness
