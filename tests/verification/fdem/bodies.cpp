#include "tests/verification/fdem/bodies.hpp"

#include "solver/fdem/mesh/assemble.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;
using Place = std::function<bool(double, double)>;

bool holds(const TriangleMesh& mesh, int node, const Place& inside) {
  const auto& at = mesh.nodes[static_cast<Index>(node)];
  return inside(at[0], at[1]);
}

// job(triangle, k) for every side of a triangle whose ends are both inside.
template <class Job>
void each_side(const TriangleMesh& mesh, const Place& inside, const Job& job) {
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (Index k = 0; k < 3; ++k)
      if (holds(mesh, mesh.triangles[t][k], inside) && holds(mesh, mesh.triangles[t][(k + 1) % 3], inside)) job(t, k);
}

}  // namespace

Material cohesive(double density, double young, double poisson, const Cohesion& cohesion) {
  Material material;
  material.name = "custom";
  material.density = density;
  material.elasticity = isotropic(young, poisson);
  material.young = young, material.poisson = poisson;
  material.cohesion = cohesion;
  return material;
}

Material unbreakable_material(std::string_view name) {
  Material material = *find_material(name);
  material.cohesion = unbreakable;
  return material;
}

TriangleMesh crossed_mesh(const std::vector<double>& x, const std::vector<double>& z) {
  fdem::Soup soup;
  const int columns = static_cast<int>(x.size()), rows = static_cast<int>(z.size());
  for (const double height : z)
    for (const double place : x) soup.nodes.push_back({place, height});
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i, b = a + 1, c = b + columns, d = a + columns, middle = static_cast<int>(soup.nodes.size());
      const Index p = static_cast<Index>(i), q = static_cast<Index>(j);
      soup.nodes.push_back({0.5 * (x[p] + x[p + 1]), 0.5 * (z[q] + z[q + 1])});
      for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}}) soup.triangles.push_back({from, to, middle});
    }
  return fdem::assemble(soup).value();
}

std::vector<double> parts_of(double from, double to, int count) {
  std::vector<double> places;
  for (int i = 0; i <= count; ++i) places.push_back(from + (to - from) * i / count);
  return places;
}

std::vector<int> edges_where(const TriangleMesh& mesh, const Place& inside) {
  std::vector<int> edges;
  for (Index e = 0; e < mesh.edge_nodes.size(); ++e)
    if (holds(mesh, mesh.edge_nodes[e][0], inside) && holds(mesh, mesh.edge_nodes[e][1], inside)) edges.push_back(static_cast<int>(e));
  return edges;
}

std::vector<fdem::Corner> corners_where(const TriangleMesh& mesh, const Place& inside) {
  std::vector<fdem::Corner> corners;
  each_side(mesh, inside, [&](Index t, Index k) {
    corners.push_back(static_cast<int>(3 * t + k)), corners.push_back(static_cast<int>(3 * t + (k + 1) % 3));
  });
  return corners;
}

fdem::Told held(std::vector<fdem::Corner> corners, Axis axis) {
  return {std::move(corners), axis, [](double) { return 0.0; }, std::nullopt};
}

fdem::Pull pull_on(const TriangleMesh& mesh, const Place& inside, std::array<double, 2> traction, std::function<double(double)> share) {
  fdem::Pull pull{{}, {}, std::move(share)};
  each_side(mesh, inside, [&](Index t, Index k) {
    const auto &a = mesh.nodes[static_cast<Index>(mesh.triangles[t][k])],
               &b = mesh.nodes[static_cast<Index>(mesh.triangles[t][(k + 1) % 3])];
    const double half = 0.5 * std::hypot(b[0] - a[0], b[1] - a[1]);
    for (const Index corner : {3 * t + k, 3 * t + (k + 1) % 3}) {
      pull.corners.push_back(static_cast<int>(corner));
      pull.force.push_back({half * traction[0], half * traction[1]});
    }
  });
  return pull;
}

FdemSettings reference_settings(double element_size) {
  FdemSettings settings;
  settings.tier = FdemTier::reference;
  settings.element_size = element_size;
  return settings;
}

}  // namespace fracfarm::verification
