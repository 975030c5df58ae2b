// Two bodies in one FDEM body: meshes side by side whose boundaries can touch, and what contact cases read of each.
#pragma once

#include <array>
#include <vector>

#include "tests/verification/fdem/bodies.hpp"

namespace fracfarm::verification {

// Nodes, triangles and edges of both; no edge joins them.
inline TriangleMesh side_by_side(TriangleMesh first, const TriangleMesh& second) {
  const int nodes = static_cast<int>(first.nodes.size()), triangles = static_cast<int>(first.triangles.size());
  first.nodes.insert(first.nodes.end(), second.nodes.begin(), second.nodes.end());
  for (auto t : second.triangles) first.triangles.push_back({t[0] + nodes, t[1] + nodes, t[2] + nodes});
  for (auto e : second.edge_nodes) first.edge_nodes.push_back({e[0] + nodes, e[1] + nodes});
  for (auto e : second.edge_triangles) first.edge_triangles.push_back({e[0] + triangles, e[1] + triangles});
  first.edge_kind.insert(first.edge_kind.end(), second.edge_kind.begin(), second.edge_kind.end());
  return first;
}

// A body of two meshes, each a continuum whose whole boundary can touch.
inline fdem::Body two_bodies(const TriangleMesh& first, const TriangleMesh& second, const Material& material) {
  fdem::Body body;
  body.mesh = side_by_side(first, second), body.materials = {material};
  body.asleep.assign(body.mesh.edge_nodes.size(), 1);
  std::vector<unsigned char> inner(3 * body.mesh.triangles.size(), 0);
  for (std::size_t e = 0; e < body.mesh.edge_nodes.size(); ++e)
    for (const int t : body.mesh.edge_triangles[e])
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& nodes = body.mesh.triangles[static_cast<std::size_t>(t)];
        const int a = nodes[k], b = nodes[(k + 1) % 3], p = body.mesh.edge_nodes[e][0], q = body.mesh.edge_nodes[e][1];
        if ((a == p && b == q) || (a == q && b == p)) inner[3 * static_cast<std::size_t>(t) + k] = 1;
      }
  for (std::size_t side = 0; side < inner.size(); ++side)
    if (!inner[side]) body.exposed.push_back(static_cast<int>(side));
  return body;
}

// Mean velocity and displacement of the triangles in [from, to), by mass.
struct Drift {
  std::array<double, 2> velocity{}, displacement{};
  double mass = 0.0, kinetic = 0.0;  // of the mean velocity, J/m
};

template <class Real>
Drift drift_of(const Run<Real>& run, int from, int to) {
  Drift out;
  for (int corner = 3 * from; corner < 3 * to; ++corner) {
    const double m = run.mass(corner);
    out.mass += m;
    for (int axis = 0; axis < 2; ++axis) {
      out.velocity[static_cast<std::size_t>(axis)] += m * run.v(corner, axis);
      out.displacement[static_cast<std::size_t>(axis)] += m * run.u(corner, axis);
    }
  }
  for (std::size_t axis = 0; axis < 2; ++axis) out.velocity[axis] /= out.mass, out.displacement[axis] /= out.mass;
  out.kinetic = 0.5 * out.mass * (out.velocity[0] * out.velocity[0] + out.velocity[1] * out.velocity[1]);
  return out;
}

// The same acceleration of all corners of the triangles in [from, to), growing together.
template <class Share>
fdem::Pull weight_on(const TriangleMesh& mesh, double density, std::array<int, 2> range, std::array<double, 2> acceleration, Share share) {
  fdem::Pull pull{{}, {}, share};
  for (int t = range[0]; t < range[1]; ++t) {
    const auto& nodes = mesh.triangles[static_cast<std::size_t>(t)];
    const auto &a = mesh.nodes[static_cast<std::size_t>(nodes[0])], &b = mesh.nodes[static_cast<std::size_t>(nodes[1])],
               &c = mesh.nodes[static_cast<std::size_t>(nodes[2])];
    const double third = density / 6.0 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    for (int k = 0; k < 3; ++k) {
      pull.corners.push_back(3 * t + k);
      pull.force.push_back({third * acceleration[0], third * acceleration[1]});
    }
  }
  return pull;
}

inline double smooth_step(double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); }

}  // namespace fracfarm::verification
