// Nodes and triangles into a TriangleMesh by its conventions: triangles along a Hilbert curve, nodes and edges numbered as triangles first
// touch them, edges between two triangles each once.
#pragma once

#include <array>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::fdem {

struct Soup {
  std::vector<std::array<double, 2>> nodes;      // m
  std::vector<std::array<int, 3>> triangles;     // counter-clockwise
  std::vector<std::pair<int, int>> crack_edges;  // by nodes, in any direction and order
};

// A sentence where an edge has more than two triangles or two that turn against each other, where a node has no triangle, or where a crack
// edge is not there.
tl::expected<TriangleMesh, std::string> assemble(const Soup& soup);

// Edges with one triangle only, as pairs of nodes with the triangle on the left.
std::vector<std::pair<int, int>> outline_of(const TriangleMesh& mesh);

}  // namespace fracfarm::fdem
