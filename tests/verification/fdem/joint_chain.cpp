// FD-3: joints in series with triangles: uniform stress, waves along a bar, and what the fast tier makes up for.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "solver/fdem/mesh/make_mesh.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;
using Vector = std::array<double, 2>;

constexpr double a = 0.001;  // m, of a square of four triangles
constexpr double young = 20e9, density = 2500.0;

// Four triangles in a square: their diagonals add sqrt 2 of a joint across the square, its sides 1.
constexpr double joints_across = 1.0 + std::numbers::sqrt2;

struct State {
  double xx, zz, xz;
  Vector on(double x, double z) const { return {xx * x + xz * z, xz * x + zz * z}; }
};

// Displacements of a uniform stress: every triangle strained alike and moved so that every joint is open by stress times its normal over p.
std::vector<Vector> uniform_stress(const TriangleMesh& mesh, const State& stress, const State& strain, double penalty) {
  std::vector<Vector> u;
  for (const auto& triangle : mesh.triangles) {
    Vector centre{};
    for (const int node : triangle)
      for (Index axis = 0; axis < 2; ++axis) centre[axis] += mesh.nodes[static_cast<Index>(node)][axis] / 3.0;
    const double i = std::floor(centre[0] / a), j = std::floor(centre[1] / a);
    const double x = centre[0] / a - i - 0.5, z = centre[1] / a - j - 0.5;
    const Vector way = std::abs(x) > std::abs(z) ? Vector{x > 0.0 ? 1.0 : -1.0, 0.0} : Vector{0.0, z > 0.0 ? 1.0 : -1.0};
    const Vector squares = stress.on(joints_across * i, joints_across * j), own = stress.on(way[0], way[1]);
    for (const int node : triangle) {
      const auto& at = mesh.nodes[static_cast<Index>(node)];
      const Vector bulk = strain.on(at[0], at[1]);
      Vector moved{};
      for (Index axis = 0; axis < 2; ++axis) moved[axis] = bulk[axis] + (squares[axis] + own[axis] / std::numbers::sqrt2) / penalty;
      u.push_back(moved);
    }
  }
  return u;
}

Row patch() {
  const Material material = cohesive(density, young, 0.25, unbreakable);
  FdemSettings settings = reference_settings(a);
  settings.penalty = 10.0;
  fdem::Body body;
  body.mesh = crossed_mesh(parts_of(0.0, 6 * a, 6), parts_of(0.0, 6 * a, 6)), body.materials = {material};
  const Elasticity& C = material.elasticity;
  const State strain{1e-5, -2e-5, 1.5e-5};  // symmetric: nothing turns
  const State stress{C.C11 * strain.xx + C.C13 * strain.zz, C.C13 * strain.xx + C.C33 * strain.zz, 2.0 * C.C55 * strain.xz};
  body.displacement = uniform_stress(body.mesh, stress, strain, 10.0 * young / a);
  Run<double> run(std::move(body), settings);
  if (!run.start()) return compare("start", "1", 0.0, INFINITY, 0.0);
  // Half a step back from rest shows the forces.
  double worst = 0.0;
  for (fdem::Corner corner = 0; corner < run.corners(); ++corner) {
    const auto& at =
        run.body()
            .mesh.nodes[static_cast<Index>(run.body().mesh.triangles[static_cast<Index>(corner / 3)][static_cast<Index>(corner % 3)])];
    if (std::min({at[0], at[1], 6 * a - at[0], 6 * a - at[1]}) < 0.1 * a) continue;
    for (const int axis : {0, 1})
      worst = std::max(worst, std::abs(run.v(corner, axis)) * 2.0 / run.dt() * run.mass(corner) / (std::abs(stress.xx) * a));
  }
  return compare("patch of 144 triangles, all joints awake, any uniform stress: worst force inside over stress times side", "1", 0.0, worst,
                 1e-10);
}

// A body with free ends in its first standing wave along x, from velocities along `axis`: c from the third time that it passes rest.
template <class Real>
double wave_speed(fdem::Body body, const FdemSettings& settings, double length, int axis) {
  const auto shape = [length](double x) { return std::cos(std::numbers::pi * x / length); };
  std::vector<double> weight;
  for (const auto& triangle : body.mesh.triangles)
    for (const int node : triangle) {
      weight.push_back(shape(body.mesh.nodes[static_cast<Index>(node)][0]));
      body.velocity.push_back({axis == 0 ? 1e-3 * weight.back() : 0.0, axis == 1 ? 1e-3 * weight.back() : 0.0});
    }
  Run<Real> run(std::move(body), settings);
  const auto swing = [&] {
    double sum = 0.0;
    for (fdem::Corner corner = 0; corner < run.corners(); ++corner)
      sum += run.mass(corner) * weight[static_cast<Index>(corner)] * run.u(corner, axis);
    return sum;
  };
  if (!run.start()) return NAN;
  constexpr int between = 8;
  double before = 0.0;
  for (int passed = 0; run.n() < 100000;) {
    run.steps(between);
    const double now = swing();
    if (before * now < 0.0 && ++passed == 3) return 3.0 * length / (run.time() - between * run.dt() * now / (now - before));
    before = now;
  }
  return NAN;
}

Row chain(double penalty) {
  FdemSettings settings = reference_settings(a);
  settings.penalty = penalty;
  fdem::Body body;
  body.mesh = crossed_mesh(parts_of(0.0, 60 * a, 60), {0.0, a}), body.materials = {cohesive(density, young, 0.0, unbreakable)};
  const double effective = young / (1.0 + joints_across / penalty);
  return compare(fmt::format("bar, all joints awake, p = {:g} E/h: c against the spring chain", penalty), "m/s",
                 std::sqrt(effective / density), wave_speed<double>(std::move(body), settings, 60 * a, 0), 0.005,
                 fmt::format("{:.2f} of the bulk's", std::sqrt(effective / young)));
}

Row sleeping() {
  fdem::Body body;
  body.mesh = crossed_mesh(parts_of(0.0, 60 * a, 60), {0.0, a}), body.materials = {cohesive(density, young, 0.0, unbreakable)};
  body.asleep.assign(body.mesh.edge_nodes.size(), 1);
  return compare("bar, all joints asleep: c", "m/s", std::sqrt(young / density),
                 wave_speed<double>(std::move(body), reference_settings(a), 60 * a, 0), 0.005);
}

// A strip that cannot widen on a mesh of the project's mesher: P waves along it, or S waves with the motion along z.
template <class Real>
double strip_speed(std::string_view name, FdemTier tier, bool shear) {
  FdemSettings settings;
  settings.tier = tier;
  if (tier == FdemTier::fast) settings.penalty = 8.0;  // joints that never break would have the reference tier's
  constexpr double length = 0.15, height = 0.03;
  fdem::MeshChoice choice;
  choice.width = length, choice.height = height;
  fdem::Body body;
  body.mesh = fdem::make_mesh(choice).value().mesh, body.materials = {unbreakable_material(name)};
  auto edges = corners_where(body.mesh, at_z(0.0));
  for (const fdem::Corner corner : corners_where(body.mesh, at_z(height))) edges.push_back(corner);
  body.told.push_back(held(std::move(edges), shear ? Axis::x : Axis::z));
  return wave_speed<Real>(std::move(body), settings, length, shear ? 1 : 0);
}

Row strip(std::string_view name, bool shear) {
  const Material& material = *find_material(name);
  const double bulk = std::sqrt((shear ? material.elasticity.C55 : material.elasticity.C11) / material.density);
  const double stiff_joints = strip_speed<double>(name, FdemTier::reference, shear);
  return compare(fmt::format("{}, mesh of the mesher: c of {} waves, fast tier against reference tier", name, shear ? "S" : "P"), "m/s",
                 stiff_joints, strip_speed<float>(name, FdemTier::fast, shear), 0.005,
                 fmt::format("{:.4f} of the bulk's", stiff_joints / bulk));
}

}  // namespace

std::vector<Row> joint_chain(Desk&) {
  std::vector<Row> rows{patch()};
  for (const double penalty : {1.0, 10.0, 100.0}) rows.push_back(chain(penalty));
  rows.push_back(sleeping());
  for (const bool shear : {false, true})
    for (const std::string_view name : {"shale", "pbx"}) rows.push_back(strip(name, shear));
  return rows;
}

}  // namespace fracfarm::verification
