// Small meshes and runs that the tests of FDEM share.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "solver/fdem/fdem.hpp"
#include "solver/fdem/solver.hpp"

namespace fracfarm::test {

using fdem::Body;

// Interior edges of nodes and triangles, each once; those that `is_crack` names (by their middle) are open from the start.
inline void find_edges(TriangleMesh& mesh, const std::function<bool(double, double)>& is_crack = {}) {
  std::map<std::array<int, 2>, int> half;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) half[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
  for (const auto& [edge, left] : half) {
    const auto other = half.find({edge[1], edge[0]});
    if (other == half.end() || edge[0] > edge[1]) continue;
    const auto &a = mesh.nodes[static_cast<std::size_t>(edge[0])], &b = mesh.nodes[static_cast<std::size_t>(edge[1])];
    mesh.edge_nodes.push_back(edge);
    mesh.edge_triangles.push_back({left, other->second});
    mesh.edge_kind.push_back(is_crack && is_crack(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])) ? EdgeKind::crack : EdgeKind::joint);
  }
}

// A rectangle of columns x rows squares, each of two triangles with diagonals in turn, inner nodes moved a little so that no two are alike.
inline TriangleMesh rectangle(int columns, int rows, double h, const std::function<bool(double, double)>& is_crack = {}) {
  TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const bool inner = i > 0 && i < columns && j > 0 && j < rows;
      const double x = inner ? 0.13 * std::sin(5.0 * i + 3.0 * j) : 0.0, z = inner ? 0.13 * std::cos(2.0 * i - 7.0 * j) : 0.0;
      mesh.nodes.push_back({(i + x) * h, (j + z) * h});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int sw = j * (columns + 1) + i, se = sw + 1, nw = sw + columns + 1, ne = nw + 1;
      if ((i + j) % 2 == 0)
        mesh.triangles.push_back({sw, se, ne}), mesh.triangles.push_back({sw, ne, nw});
      else
        mesh.triangles.push_back({sw, se, nw}), mesh.triangles.push_back({se, ne, nw});
    }
  find_edges(mesh, is_crack);
  return mesh;
}

inline FdemSettings settings_of(FdemTier tier, double h) {
  FdemSettings settings;
  settings.tier = tier;
  settings.element_size = h;
  return settings;
}

inline constexpr double plate_h = 0.004;
inline constexpr int plate_cells = 16;

// A square between plates that part briskly, with a crack from its left side: breaks within 60 us.
inline Scene plate_scene(std::string_view material, FdemTier tier) {
  Scene scene;
  scene.method = Method::fdem;
  scene.width = scene.height = plate_cells * plate_h;
  scene.layers = {{scene.height, *find_material(material)}};
  SideLoad pull;
  pull.to = scene.width, pull.normal_velocity = 5.0, pull.tangential = Tangential::fixed, pull.ramp = 1e-5;
  scene.loads[static_cast<std::size_t>(Side::top)] = {pull};
  scene.loads[static_cast<std::size_t>(Side::bottom)] = {pull};
  scene.fdem = settings_of(tier, plate_h);
  return scene;
}

inline TriangleMesh plate_mesh() {
  const double middle = plate_cells / 2 * plate_h;
  return rectangle(plate_cells, plate_cells, plate_h,
                   [=](double x, double z) { return x < 0.4 * middle && std::abs(z - middle) < 0.3 * plate_h; });
}

// A scene's body in a chosen number type and instruction set.
template <class Real>
std::unique_ptr<fdem::Fdem<Real>> plate(std::string_view material, FdemTier tier, const Rules& rules = {}, int threads = 1,
                                        const fdem::Kernels<Real>& kernels = fdem::chosen_kernels<Real>()) {
  const Scene scene = plate_scene(material, tier);
  return std::make_unique<fdem::Fdem<Real>>(fdem::body_of(scene, plate_mesh()), scene.fdem, rules, threads, kernels);
}

inline void go(MeshSimulation& run, double dt, long long from, long long to) {
  if (from == 0) REQUIRE(run.start(dt));
  for (long long n = from; n < to; ++n) REQUIRE(run.step(n, dt));
}

inline int broken(const MeshSimulation& run) {
  int count = 0;
  for (const double time : run.break_time()) count += !std::isnan(time);
  return count;
}

}  // namespace fracfarm::test
