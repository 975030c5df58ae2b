// What every accepted run on a mesh must satisfy: the table that accepted.hpp takes where the result has a mesh.
#pragma once

#include "tests/robustness/accepted.hpp"

namespace fracfarm::robustness {

std::span<const AcceptanceRule> mesh_acceptance_rules();
double mesh_ledger_share(const RunResult& result);

}  // namespace fracfarm::robustness
