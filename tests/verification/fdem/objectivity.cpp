// FD-2: a body does not know where it is, how it is turned, or how its parts are numbered.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "common/base/random.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;
using Vector = std::array<double, 2>;

constexpr double size = 0.03, h = 0.003;  // m

struct Pose {
  double angle = 0.0;  // degrees
  Vector shift{};      // m
  Vector turned(const Vector& p) const {
    const double c = std::cos(angle * std::numbers::pi / 180.0), s = std::sin(angle * std::numbers::pi / 180.0);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1]};
  }
  Vector moved(const Vector& p) const {
    const Vector q = turned(p);
    return {q[0] + shift[0], q[1] + shift[1]};
  }
};

const TriangleMesh& mesh() {
  static const TriangleMesh made = [] {
    fdem::MeshChoice choice;
    choice.width = choice.height = size, choice.element_size = h;
    return fdem::make_mesh(choice).value().mesh;
  }();
  return made;
}

Vector node_of(const TriangleMesh& mesh, int corner) {
  return mesh.nodes[static_cast<Index>(mesh.triangles[static_cast<Index>(corner / 3)][static_cast<Index>(corner % 3)])];
}

// Shale, whose stiffness has axes of its own; posed whole, and torn apart by a velocity gradient if `rate` (1/s) says so.
fdem::Body posed(const TriangleMesh& mesh, const Pose& pose, double rate) {
  fdem::Body body;
  body.mesh = mesh, body.materials = {*find_material("shale")};
  for (int corner = 0; corner < static_cast<int>(3 * mesh.triangles.size()); ++corner) {
    const Vector at = node_of(mesh, corner), to = pose.moved(at);
    const double x = at[0] - 0.5 * size, z = at[1] - 0.5 * size;
    body.displacement.push_back({to[0] - at[0], to[1] - at[1]});
    body.velocity.push_back(pose.turned({rate * (1.0 * x + 0.3 * z), rate * (-0.2 * x + 0.6 * z)}));
  }
  return body;
}

// At rest, posed: the largest force on a corner over C11 h, and the largest mean stress over C11.
double largest_stress(const Pose& pose) {
  Run<double> run(posed(mesh(), pose, 0.0), reference_settings(h));
  if (!run.start()) return INFINITY;
  const double C11 = run.body().materials[0].elasticity.C11;
  const SampleRow row = run.sample();
  double worst = std::max(std::abs(row.stress_xx), std::abs(row.stress_zz)) / C11;
  for (fdem::Corner corner = 0; corner < run.corners(); ++corner)
    for (const int axis : {0, 1}) {
      const double force = std::abs(run.v(corner, axis)) * 2.0 / run.dt() * run.mass(corner) / (C11 * h);
      worst = std::isfinite(force) ? std::max(worst, force) : INFINITY;
    }
  return worst;
}

Row spin() {
  double worst = 0.0;
  for (int i = 1; i <= 24; ++i) worst = std::max(worst, largest_stress({15.0 * i, {0.02 * i, -0.01 * i}}));
  return compare("turned by 15 to 360 degrees and shifted by up to 0.5 m: largest stress and joint force over C11", "1", 0.0, worst, 1e-12);
}

struct Torn {
  std::vector<Vector> place;  // of corners, m
  std::vector<float> damage;  // by edge
  SampleRow row;
  int broken = 0;
};

constexpr int tearing_steps = 300;

Torn tear(const TriangleMesh& mesh, const Pose& pose) {
  Run<double> run(posed(mesh, pose, 8000.0), reference_settings(h));
  run.use_dt(1e-8);
  Torn torn;
  if (!run.start()) return torn;
  run.steps(tearing_steps);
  for (fdem::Corner corner = 0; corner < run.corners(); ++corner) {
    const Vector at = node_of(mesh, corner);
    torn.place.push_back({at[0] + run.u(corner, 0), at[1] + run.u(corner, 1)});
  }
  torn.damage = run.fdem().stored_damage(), torn.row = run.sample();
  torn.broken = static_cast<int>(std::count_if(torn.damage.begin(), torn.damage.end(), [](float d) { return d >= 1.0F; }));
  return torn;
}

struct Difference {
  double place = 0.0;  // over the body's size
  double energy = 0.0;
  double damage = 0.0;
};

Row torn_alike(std::string what, const Torn& one, const Torn& other, const Pose& pose) {
  Difference worst;
  for (Index i = 0; i < one.place.size(); ++i) {
    const Vector to = pose.moved(one.place[i]);
    for (Index axis = 0; axis < 2; ++axis) {
      const double apart = std::abs(to[axis] - other.place[i][axis]) / size;
      worst.place = std::isfinite(apart) ? std::max(worst.place, apart) : INFINITY;
    }
  }
  for (Index e = 0; e < one.damage.size(); ++e)
    worst.damage = std::max(worst.damage, static_cast<double>(std::abs(one.damage[e] - other.damage[e])));
  worst.energy = std::abs(one.row.elastic_energy / other.row.elastic_energy - 1.0);
  return compare(std::move(what), "1", 0.0, worst.place, 1e-12,
                 fmt::format("{} joints broken; D within {:.0e}, elastic energy within {:.0e}", one.broken, worst.damage, worst.energy));
}

// Everything numbered anew, corners of triangles and ends of edges included; where old corners and edges went.
struct Renumbered {
  TriangleMesh mesh;
  std::vector<int> corner, edge;  // new numbers of the old
};

std::vector<int> shuffled(Index count, RandomStream& random) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (Index i = count; i > 1; --i) std::swap(order[i - 1], order[static_cast<Index>(random.uniform(0.0, 1.0) * static_cast<double>(i))]);
  return order;
}

Renumbered renumbered(const TriangleMesh& old) {
  RandomStream random(2026, 1, 2);
  const std::vector<int> node = shuffled(old.nodes.size(), random), triangle = shuffled(old.triangles.size(), random);
  Renumbered now{old, std::vector<int>(3 * old.triangles.size()), shuffled(old.edge_nodes.size(), random)};
  const auto at = [](const std::vector<int>& numbers, Index i) { return static_cast<Index>(numbers[i]); };
  for (Index i = 0; i < old.nodes.size(); ++i) now.mesh.nodes[at(node, i)] = old.nodes[i];
  for (Index t = 0; t < old.triangles.size(); ++t) {
    const Index turn = static_cast<Index>(random.uniform(0.0, 3.0));
    for (Index k = 0; k < 3; ++k) {
      const Index to = (k + turn) % 3;
      now.mesh.triangles[at(triangle, t)][to] = node[static_cast<Index>(old.triangles[t][k])];
      now.corner[3 * t + k] = static_cast<int>(3 * at(triangle, t) + to);
    }
  }
  for (Index e = 0; e < old.edge_nodes.size(); ++e) {
    const Index flip = random.uniform(0.0, 1.0) < 0.5, to = at(now.edge, e);
    for (Index k = 0; k < 2; ++k) {
      now.mesh.edge_nodes[to][(k + flip) % 2] = node[static_cast<Index>(old.edge_nodes[e][k])];
      now.mesh.edge_triangles[to][(k + flip) % 2] = triangle[static_cast<Index>(old.edge_triangles[e][k])];
    }
    now.mesh.edge_kind[to] = old.edge_kind[e];
  }
  return now;
}

// In the old numbers.
Torn tear_renumbered() {
  const Renumbered now = renumbered(mesh());
  const Torn torn = tear(now.mesh, {});
  Torn back = torn;
  for (Index i = 0; i < torn.place.size(); ++i) back.place[i] = torn.place[static_cast<Index>(now.corner[i])];
  for (Index e = 0; e < torn.damage.size(); ++e) back.damage[e] = torn.damage[static_cast<Index>(now.edge[e])];
  return back;
}

}  // namespace

std::vector<Row> objectivity(Desk&) {
  std::vector<Row> rows{spin()};
  const Torn as_is = tear(mesh(), {});
  for (const Pose& pose : {Pose{0.0, {0.1, -0.05}}, Pose{77.0, {}}, Pose{180.0, {0.02, 0.03}}, Pose{300.0, {}}}) {
    const Torn other = tear(mesh(), pose);
    rows.push_back(torn_alike(fmt::format("torn apart, the same turned by {:g} degrees, shifted by ({:g}, {:g}) m: places over size",
                                          pose.angle, pose.shift[0], pose.shift[1]),
                              as_is, other, pose));
  }
  const Torn other = tear_renumbered();
  rows.push_back(torn_alike("torn apart, everything numbered anew: places over size", as_is, other, {}));
  return rows;
}

}  // namespace fracfarm::verification
