// What every mesh must be, looked at without the mesher's own checks: conventions of TriangleMesh, area, outline, heights, cracks covered.
#pragma once

#include <string>

#include "solver/fdem/mesh/make_mesh.hpp"

namespace fracfarm::fdem {

// The first thing that is wrong, or nothing. `crack_reach` (elements): how far from a drawn crack its edges may lie.
std::string fault_of(const TriangleMesh& mesh, const MeshChoice& choice, double crack_reach = 0.75);

double lowest_height(const TriangleMesh& mesh);  // m

// "made", "refused", or what is wrong with what was made.
std::string verdict_on(const MeshChoice& choice, double crack_reach = 0.75);

}  // namespace fracfarm::fdem
