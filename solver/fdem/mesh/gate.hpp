// The gate every mesh passes before a run: what it measures goes to the report, what fails is said with value and limit.
#pragma once

#include <string>

#include "solver/fdem/mesh/make_mesh.hpp"

namespace fracfarm::fdem {

inline constexpr double area_error_allowed = 1e-12;  // relative: rounding of the sum

// Fills the measured lines of the report; empty where the mesh is good.
std::string gate(const TriangleMesh& mesh, const MeshChoice& choice, MeshReport& report);

// Do cracks of the choice, clipped to the body, and crack edges of the mesh lie within `reach` metres of each other? The first that does
// not; empty: all do. A crack along a side needs no edge.
std::string strayed_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach);

}  // namespace fracfarm::fdem
