#include "tests/studies/squeeze.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::studies {
namespace {

using Index = std::size_t;
using Place = std::array<double, 2>;

double twice_area(const Place& a, const Place& b, const Place& c) { return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]); }

double height_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Place &a = mesh.nodes[static_cast<Index>(t[0])], &b = mesh.nodes[static_cast<Index>(t[1])],
              &c = mesh.nodes[static_cast<Index>(t[2])];
  const double longest =
      std::max({std::hypot(b[0] - a[0], b[1] - a[1]), std::hypot(c[0] - b[0], c[1] - b[1]), std::hypot(a[0] - c[0], a[1] - c[1])});
  return twice_area(a, b, c) / longest;
}

// Nodes that lie on a crack or on a side of the mesh.
std::vector<bool> held_nodes(const TriangleMesh& mesh) {
  std::vector<int> edges(mesh.nodes.size(), 0), triangles(mesh.nodes.size(), 0);
  std::vector<bool> held(mesh.nodes.size(), false);
  for (Index e = 0; e < mesh.edge_nodes.size(); ++e)
    for (const int node : mesh.edge_nodes[e]) {
      ++edges[static_cast<Index>(node)];
      if (mesh.edge_kind[e] == EdgeKind::crack) held[static_cast<Index>(node)] = true;
    }
  for (const auto& t : mesh.triangles)
    for (const int node : t) ++triangles[static_cast<Index>(node)];
  for (Index n = 0; n < held.size(); ++n)
    if (edges[n] != triangles[n]) held[n] = true;  // inside, there are as many edges as triangles around a node
  return held;
}

}  // namespace

double smallest_height(const TriangleMesh& mesh) {
  double least = INFINITY;
  for (const auto& t : mesh.triangles) least = std::min(least, height_of(mesh, t));
  return least;
}

void squeeze(TriangleMesh& mesh, double height) {
  const std::vector<bool> held = held_nodes(mesh);
  for (Index t = mesh.triangles.size() / 2; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    if (held[static_cast<Index>(corners[0])]) continue;
    Place& moved = mesh.nodes[static_cast<Index>(corners[0])];
    const Place &b = mesh.nodes[static_cast<Index>(corners[1])], &c = mesh.nodes[static_cast<Index>(corners[2])];
    const Place foot{0.5 * (b[0] + c[0]), 0.5 * (b[1] + c[1])}, before = moved;
    const double own = twice_area(moved, b, c) / std::hypot(c[0] - b[0], c[1] - b[1]);
    moved = {foot[0] + (moved[0] - foot[0]) * height / own, foot[1] + (moved[1] - foot[1]) * height / own};
    if (std::abs(smallest_height(mesh) - height) < 1e-3 * height) return;
    moved = before;  // another triangle there was worse
  }
}

}  // namespace fracfarm::studies
