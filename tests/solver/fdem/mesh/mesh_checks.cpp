#include "tests/solver/fdem/mesh/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/scene/pattern.hpp"

namespace fracfarm::fdem {
namespace {

using Node = std::array<double, 2>;

long double twice_area(const Node& a, const Node& b, const Node& c) {
  return (static_cast<long double>(b[0]) - a[0]) * (static_cast<long double>(c[1]) - a[1]) -
         (static_cast<long double>(b[1]) - a[1]) * (static_cast<long double>(c[0]) - a[0]);
}

double length_of(const Node& a, const Node& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

double distance_from(const Node& p, const Node& a, const Node& b) {
  const double dx = b[0] - a[0], dz = b[1] - a[1];
  const double s = std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
  return std::hypot(p[0] - a[0] - s * dx, p[1] - a[1] - s * dz);
}

std::string wrong_area(const TriangleMesh& mesh, const MeshChoice& choice) {
  long double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const long double twice = twice_area(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]);
    if (!(twice > 0)) return "a triangle is not counter-clockwise";
    sum += 0.5L * twice;
  }
  const long double body = static_cast<long double>(choice.width) * choice.height;
  return std::fabs(sum - body) <= 1e-14L * body ? "" : "the areas do not add up to the body's";
}

// Triangles by directed edge; every edge of two triangles must be listed once, with its left and right triangle.
std::string wrong_edges(const TriangleMesh& mesh, const MeshChoice& choice) {
  std::map<std::pair<int, int>, int> left_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (!left_of.emplace(std::pair{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}, static_cast<int>(t)).second)
        return "an edge has two triangles on one side";
  std::set<std::pair<int, int>> listed;
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    const auto [a, b] = mesh.edge_nodes[e];
    const auto left = left_of.find({a, b}), right = left_of.find({b, a});
    if (left == left_of.end() || right == left_of.end()) return "a listed edge has not two triangles";
    if (mesh.edge_triangles[e] != std::array{left->second, right->second}) return "left and right of an edge are not its triangles";
    if (!listed.insert({std::min(a, b), std::max(a, b)}).second) return "an edge is listed twice";
  }
  for (const auto& [edge, triangle] : left_of) {
    const auto [a, b] = edge;
    if (listed.contains({std::min(a, b), std::max(a, b)})) continue;
    if (left_of.contains({b, a})) return "an edge between two triangles is not listed";
    const Node &p = mesh.nodes[static_cast<std::size_t>(a)], &q = mesh.nodes[static_cast<std::size_t>(b)];
    const bool side = (p[0] == q[0] && (p[0] == 0 || p[0] == choice.width)) || (p[1] == q[1] && (p[1] == 0 || p[1] == choice.height));
    if (!side) return "the mesh ends inside the body";
  }
  return mesh.edge_kind.size() == mesh.edge_nodes.size() ? "" : "kinds and edges differ in number";
}

std::string layer_not_followed(const TriangleMesh& mesh, const MeshChoice& choice) {
  for (const double layer : choice.layers) {
    double along = 0;
    for (const auto& [a, b] : mesh.edge_nodes)
      if (mesh.nodes[a][1] == layer && mesh.nodes[b][1] == layer) along += length_of(mesh.nodes[a], mesh.nodes[b]);
    if (std::fabs(along - choice.width) > 1e-12 * choice.width) return "edges do not lie along a layer";
  }
  return {};
}

std::string lost_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach) {
  for (Segment crack : choice.cracks) {
    if (!clip(crack, choice.width, choice.height)) continue;
    for (int k = 0; k <= 60; ++k) {
      const double s = k / 60.0;
      const Node p{crack.x0 + s * (crack.x1 - crack.x0), crack.z0 + s * (crack.z1 - crack.z0)};
      double nearest = std::min({p[0], p[1], choice.width - p[0], choice.height - p[1]});
      for (std::size_t e = 0; e < mesh.edge_nodes.size() && nearest >= reach; ++e)
        if (mesh.edge_kind[e] == EdgeKind::crack)
          nearest = std::min(nearest, distance_from(p, mesh.nodes[mesh.edge_nodes[e][0]], mesh.nodes[mesh.edge_nodes[e][1]]));
      if (nearest >= reach) return "a part of a crack has no edge along it";
    }
  }
  return {};
}

// No crack edge far from every crack that was drawn.
std::string invented_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach) {
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    if (mesh.edge_kind[e] != EdgeKind::crack) continue;
    const Node &a = mesh.nodes[mesh.edge_nodes[e][0]], &b = mesh.nodes[mesh.edge_nodes[e][1]];
    const Node middle{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    double nearest = 1e300;
    for (const Segment& crack : choice.cracks)
      nearest = std::min(nearest, distance_from(middle, {crack.x0, crack.z0}, {crack.x1, crack.z1}));
    if (nearest >= reach) return "an edge is cracked where no crack was drawn";
  }
  return {};
}

}  // namespace

double lowest_height(const TriangleMesh& mesh) {
  double lowest = 1e300;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Node &p = mesh.nodes[a], &q = mesh.nodes[b], &r = mesh.nodes[c];
    lowest = std::min(lowest, static_cast<double>(twice_area(p, q, r)) / std::max({length_of(p, q), length_of(q, r), length_of(r, p)}));
  }
  return lowest;
}

std::string fault_of(const TriangleMesh& mesh, const MeshChoice& choice, double crack_reach) {
  const double reach = crack_reach * choice.element_size;
  for (const std::string& fault : {wrong_area(mesh, choice), wrong_edges(mesh, choice), layer_not_followed(mesh, choice),
                                   lost_crack(mesh, choice, reach), invented_crack(mesh, choice, reach)})
    if (!fault.empty()) return fault;
  return lowest_height(mesh) >= 0.4 / 3.0 * choice.element_size ? "" : "a triangle is too flat";
}

std::string verdict_on(const MeshChoice& choice, double crack_reach) {
  const MeshResult made = make_mesh(choice);
  if (!made) return made.error().empty() ? "refused without a reason" : "refused";
  const std::string fault = fault_of(made->mesh, choice, crack_reach);
  return fault.empty() ? "made" : fault;
}

}  // namespace fracfarm::fdem
