#include "solver/fdem/mesh/gate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/assemble.hpp"
#include "solver/fdem/mesh/geometry.hpp"

namespace fracfarm::fdem {
namespace {

struct Shapes {
  double height_squared = 1e300, cotangent = -1e300, area = 0.0;
  std::size_t lowest = 0;  // triangle of that height
};

// The smallest angle lies opposite the shortest edge: the largest ratio of dot to cross product over all corners.
Shapes measure(const TriangleMesh& mesh) {
  Shapes shapes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& node = mesh.nodes[static_cast<std::size_t>(mesh.triangles[t][k])];
      p[k] = {node[0], node[1]};
    }
    const double twice = cross(p[1] - p[0], p[2] - p[0]);
    shapes.area += 0.5 * twice;
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      longest = std::max(longest, dot(u, u));
      shapes.cotangent = std::max(shapes.cotangent, dot(u, v) / twice);
    }
    const double height = twice > 0 ? twice * twice / longest : 0.0;
    if (height < shapes.height_squared) shapes.height_squared = height, shapes.lowest = t;
  }
  return shapes;
}

bool on_a_side(const std::array<double, 2>& p, const std::array<double, 2>& q, const MeshChoice& choice) {
  return (p[0] == q[0] && (p[0] == 0.0 || p[0] == choice.width)) || (p[1] == q[1] && (p[1] == 0.0 || p[1] == choice.height));
}

Vec node(const TriangleMesh& mesh, int i) {
  return {mesh.nodes[static_cast<std::size_t>(i)][0], mesh.nodes[static_cast<std::size_t>(i)][1]};
}

std::vector<Segment> crack_edges_of(const TriangleMesh& mesh, const MeshChoice& choice) {
  std::vector<Segment> edges{{0, 0, choice.width, 0},
                             {0, choice.height, choice.width, choice.height}};  // a crack along a side parts nothing
  edges.push_back({0, 0, 0, choice.height});
  edges.push_back({choice.width, 0, choice.width, choice.height});
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    if (mesh.edge_kind[e] != EdgeKind::crack) continue;
    const Vec p = node(mesh, mesh.edge_nodes[e][0]), q = node(mesh, mesh.edge_nodes[e][1]);
    edges.push_back({p.x, p.z, q.x, q.z});
  }
  return edges;
}

// Samples each crack four times an element. The edge of the last sample is asked first, then those after it: edges of a crack mostly follow
// each other.
std::string uncovered_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach) {
  const std::vector<Segment> edges = crack_edges_of(mesh, choice);
  std::size_t last_hit = 0;
  const auto covered = [&](Vec p) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::size_t e = (last_hit + i) % edges.size();
      if (distance_to(p, first(edges[e]), last(edges[e])) >= reach) continue;
      last_hit = e;
      return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < choice.cracks.size(); ++i) {
    Segment crack = choice.cracks[i];
    if (!clip(crack, choice.width, choice.height)) continue;
    const int samples = static_cast<int>(std::ceil(4 * length(crack) / choice.element_size)) + 1;
    for (int k = 0; k <= samples; ++k)
      if (const Vec p = along(first(crack), last(crack), static_cast<double>(k) / samples); !covered(p))
        return fmt::format("crack {} has no edge of the mesh along it at ({:.6g}, {:.6g}) m, within {:.3g} mm", i, p.x, p.z, 1e3 * reach);
  }
  return {};
}

std::string invented_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach) {
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    if (mesh.edge_kind[e] != EdgeKind::crack) continue;
    const Vec middle = along(node(mesh, mesh.edge_nodes[e][0]), node(mesh, mesh.edge_nodes[e][1]), 0.5);
    const auto near = [&](const Segment& crack) { return distance_to(middle, first(crack), last(crack)) < reach; };
    if (std::none_of(choice.cracks.begin(), choice.cracks.end(), near))
      return fmt::format("an edge of the mesh at ({:.6g}, {:.6g}) m is a crack, with no crack of the scene within {:.3g} mm", middle.x,
                         middle.z, 1e3 * reach);
  }
  return {};
}

}  // namespace

std::string gate(const TriangleMesh& mesh, const MeshChoice& choice, MeshReport& report) {
  const Shapes shapes = measure(mesh);
  const double area = choice.width * choice.height, least = smallest_height_allowed * choice.element_size;
  report.smallest_height = std::sqrt(shapes.height_squared);
  report.smallest_angle = std::atan2(1.0, shapes.cotangent) * 180 / std::numbers::pi;
  report.area_error = std::fabs(shapes.area - area) / area;
  for (const auto& [a, b] : outline_of(mesh)) {
    const auto &p = mesh.nodes[static_cast<std::size_t>(a)], &q = mesh.nodes[static_cast<std::size_t>(b)];
    if (!on_a_side(p, q, choice))
      return fmt::format("the mesh ends at an edge inside the body, from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m", p[0], p[1], q[0], q[1]);
  }
  if (!(report.area_error <= area_error_allowed))
    return fmt::format("the triangles cover {:.15g} of the body's {:.15g} m2", shapes.area, area);
  if (!(report.smallest_height >= least)) {
    const auto& at = mesh.nodes[static_cast<std::size_t>(mesh.triangles[shapes.lowest][0])];
    return fmt::format("a triangle near ({:.4g}, {:.4g}) m is {:.3g} mm high; at least {:.3g} mm with elements of {:.3g} mm", at[0], at[1],
                       1e3 * report.smallest_height, 1e3 * least, 1e3 * choice.element_size);
  }
  return {};
}

std::string strayed_crack(const TriangleMesh& mesh, const MeshChoice& choice, double reach) {
  std::string reason = uncovered_crack(mesh, choice, reach);
  return reason.empty() ? invented_crack(mesh, choice, reach) : reason;
}

}  // namespace fracfarm::fdem
