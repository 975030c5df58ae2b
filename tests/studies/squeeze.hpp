// Slivers on purpose: a node of a sound mesh is moved until a triangle there has a given height.
#pragma once

#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::studies {

// m, over all triangles.
double smallest_height(const TriangleMesh& mesh);

// Moves one node inside the mesh, away from cracks and sides, towards the opposite edge of one of its triangles until that triangle is
// `height` (m) high. Topology stays; every triangle stays counter-clockwise where height > 0.
void squeeze(TriangleMesh& mesh, double height);

}  // namespace fracfarm::studies
