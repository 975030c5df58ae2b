// The mesh of an FDEM run as plain data: undeformed nodes, triangles, and the interior edges that joints stand on. Made by solver/fdem,
// kept by records.
#pragma once

#include <array>
#include <vector>

namespace fracfarm {

enum class EdgeKind : unsigned char { joint = 0, crack = 1 };  // crack: open from the start, its damage is 2.0

struct TriangleMesh {
  std::vector<std::array<double, 2>> nodes;        // m, (x, z)
  std::vector<std::array<int, 3>> triangles;       // nodes, counter-clockwise
  std::vector<std::array<int, 2>> edge_nodes;      // edges between two triangles, each once
  std::vector<std::array<int, 2>> edge_triangles;  // left and right of the way from edge_nodes[e][0] to edge_nodes[e][1]
  std::vector<EdgeKind> edge_kind;
  bool operator==(const TriangleMesh&) const = default;
};

}  // namespace fracfarm
