// A scene's rectangle as a body. Loads act on the corners of those triangles that have an edge on the side: plates hold edges.
#include <algorithm>

#include "solver/fdem/fdem.hpp"
#include "solver/fdem/solver.hpp"

namespace fracfarm {
namespace fdem {
namespace {

using Index = std::size_t;

std::array<double, 2> centre_of(const TriangleMesh& mesh, Index t) {
  std::array<double, 2> centre{};
  for (const int node : mesh.triangles[t])
    for (Index axis = 0; axis < 2; ++axis) centre[axis] += mesh.nodes[static_cast<Index>(node)][axis] / 3.0;
  return centre;
}

int layer_at(const Scene& scene, double z) {
  for (Index i = 0; i + 1 < scene.layers.size(); ++i)
    if (z < scene.layers[i].below) return static_cast<int>(i);
  return static_cast<int>(scene.layers.size()) - 1;
}

void set_materials(const Scene& scene, Body& body) {
  for (const Layer& layer : scene.layers) body.materials.push_back(layer.material);
  if (scene.layers.size() < 2) return;
  for (Index t = 0; t < body.mesh.triangles.size(); ++t) body.material_of.push_back(layer_at(scene, centre_of(body.mesh, t)[1]));
}

// Both ends of each edge on a side stand for half of it.
void add_edge(SideNodes& sides, Side side, double from, double to, Corner first, Corner second) {
  auto& nodes = sides[static_cast<Index>(side)];
  const double middle = 0.5 * (from + to);
  const bool forward = from < to;
  nodes.push_back({static_cast<Index>(first), from, forward ? from : middle, forward ? middle : from});
  nodes.push_back({static_cast<Index>(second), to, forward ? middle : to, forward ? to : middle});
}

SideNodes side_nodes(const Scene& scene, const TriangleMesh& mesh) {
  SideNodes sides;
  const double slack = 1e-9 * std::max(scene.width, scene.height);
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto &a = mesh.nodes[static_cast<Index>(mesh.triangles[t][static_cast<Index>(k)])],
                 &b = mesh.nodes[static_cast<Index>(mesh.triangles[t][static_cast<Index>((k + 1) % 3)])];
      const Corner first = static_cast<Corner>(3 * t) + k, second = static_cast<Corner>(3 * t) + (k + 1) % 3;
      const auto both = [&](Index axis, double at) { return std::abs(a[axis] - at) < slack && std::abs(b[axis] - at) < slack; };
      if (both(0, 0.0)) add_edge(sides, Side::left, a[1], b[1], first, second);
      if (both(0, scene.width)) add_edge(sides, Side::right, a[1], b[1], first, second);
      if (both(1, 0.0)) add_edge(sides, Side::bottom, a[0], b[0], first, second);
      if (both(1, scene.height)) add_edge(sides, Side::top, a[0], b[0], first, second);
    }
  for (auto& nodes : sides) std::sort(nodes.begin(), nodes.end(), [](const SideNode& p, const SideNode& q) { return p.to < q.to; });
  return sides;
}

void set_loads(const Scene& scene, Body& body) {
  const Boundary boundary = build_boundary(scene, side_nodes(scene, body.mesh));
  for (const Motion& motion : boundary.motions) {
    Told told{{}, motion.axis, [motion](double time) { return motion.at(time); }, std::nullopt};
    if (motion.normal) told.side = motion.side;
    for (const Index corner : motion.nodes) told.corners.push_back(static_cast<Corner>(corner));
    body.told.push_back(std::move(told));
  }
  for (const Traction& traction : boundary.tractions) {
    Pull pull{{}, {}, [traction](double time) { return traction.share(time); }};
    for (Index i = 0; i < traction.nodes.size(); ++i) {
      pull.corners.push_back(static_cast<Corner>(traction.nodes[i]));
      pull.force.push_back({traction.fx[i], traction.fz[i]});
    }
    body.pulls.push_back(std::move(pull));
  }
  body.side_length = {scene.height, scene.height, scene.width, scene.width};
}

void set_initial_fields(const Scene& scene, Body& body) {
  if (scene.initial == Initial{}) return;
  const auto [xx, zz, xz] = scene.initial.strain;
  const auto& L = scene.initial.velocity_gradient;
  for (const auto& triangle : body.mesh.triangles)
    for (const int node : triangle) {
      const double x = body.mesh.nodes[static_cast<Index>(node)][0] - 0.5 * scene.width;
      const double z = body.mesh.nodes[static_cast<Index>(node)][1] - 0.5 * scene.height;
      body.displacement.push_back({xx * x + xz * z, xz * x + zz * z});
      body.velocity.push_back({L[0] * x + L[1] * z, L[2] * x + L[3] * z});
    }
}

}  // namespace

Body body_of(const Scene& scene, TriangleMesh mesh) {
  Body body;
  body.mesh = std::move(mesh);
  set_materials(scene, body);
  set_loads(scene, body);
  set_initial_fields(scene, body);
  return body;
}

std::unique_ptr<MeshSimulation> make_fdem(Body body, const FdemSettings& settings, const Rules& rules, int threads) {
  const Precision natural = settings.tier == FdemTier::reference ? Precision::double_ : Precision::float_;
  if (settings.precision.value_or(natural) == Precision::double_)
    return std::make_unique<Fdem<double>>(std::move(body), settings, rules, threads);
  return std::make_unique<Fdem<float>>(std::move(body), settings, rules, threads);
}

}  // namespace fdem

std::unique_ptr<MeshSimulation> make_fdem(const Scene& scene, TriangleMesh mesh, const Rules& rules, int threads) {
  return fdem::make_fdem(fdem::body_of(scene, std::move(mesh)), scene.fdem, rules, threads);
}

}  // namespace fracfarm
