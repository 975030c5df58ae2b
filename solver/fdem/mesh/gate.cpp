#include "solver/fdem/mesh/gate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

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

}  // namespace fracfarm::fdem
