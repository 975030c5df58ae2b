// The assembled path against the row kernels: two programs for the same equations, explicit with corner quadrature.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "solver/phasefield/assembled/assembled.hpp"
#include "solver/phasefield/phase_field.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using phasefield::assembled::Assembled;

namespace {

// The rows' psi solve is asked for more than in a run; the comparison is as fine as that allows.
constexpr double fine = 1e-9;
constexpr double same_psi = 1e-6, same_share = 5e-6;

struct Ended {
  SampleRow row;
  std::vector<double> psi;
  double stress;
};

Ended after_steps(GridSimulation& run, double dt, int steps) {
  REQUIRE(run.start(dt));
  for (int n = 0; n < steps; ++n) REQUIRE(run.step(n, dt));
  Ended ended{run.sample(steps, dt), {}, run.mean_stress_zz()};
  run.copy_damage(ended.psi);
  return ended;
}

struct Apart {
  double psi = 0.0;
  int steps = 0;
};

// Where two runs of one scene are farthest apart, over all nodes and `steps` steps: psi that has crept is overtaken where a crack grows.
Apart farthest_apart(GridSimulation& a, GridSimulation& b, double dt, int steps) {
  Apart apart;
  std::vector<double> psi, other;
  for (GridSimulation* run : {&a, &b}) REQUIRE(run->start(dt));
  for (int n = 0; n < steps; ++n) {
    for (GridSimulation* run : {&a, &b}) REQUIRE(run->step(n, dt));
    a.copy_damage(psi), b.copy_damage(other);
    for (std::size_t k = 0; k < psi.size(); ++k)
      if (const double here = std::abs(psi[k] - other[k]); here > apart.psi) apart = {here, n + 1};
  }
  return apart;
}

bool near(double a, double b, double scale) { return std::abs(a - b) <= same_share * std::abs(scale); }

void check_agreement(const Scene& scene, int steps, double least_damage) {
  phasefield::PhaseField<double> rows(scene, phasefield::chosen_kernels<double>());
  rows.model().damage_tolerance = fine;
  rows.model().rules.work_where_it_moves = false;
  Assembled assembled(scene);
  REQUIRE(rows.kernel() != assembled.kernel());
  CHECK(rows.stable_dt() == Approx(assembled.stable_dt()).epsilon(1e-14));
  CHECK(rows.mask() == assembled.mask());
  const double dt = 0.9 * rows.stable_dt();
  const Ended a = after_steps(rows, dt, steps), b = after_steps(assembled, dt, steps);
  double worst = 0.0, most = 0.0;
  const std::vector<unsigned char> mask = rows.mask();
  for (std::size_t n = 0; n < a.psi.size(); ++n) {
    worst = std::max(worst, std::abs(a.psi[n] - b.psi[n]));
    if (!mask[n]) most = std::max(most, a.psi[n]);
  }
  CHECK(most > least_damage);  // something was to be agreed on
  CHECK(worst < same_psi);
  const double work = a.row.external_work;
  CHECK(work > 0.0);
  CHECK(near(a.stress, b.stress, a.stress));
  CHECK(near(a.row.stress_xx, b.row.stress_xx, a.stress));
  for (std::size_t side = 0; side < 4; ++side) CHECK(near(a.row.reaction[side], b.row.reaction[side], a.stress));
  CHECK(near(a.row.kinetic_energy, b.row.kinetic_energy, work));
  CHECK(near(a.row.elastic_energy, b.row.elastic_energy, work));
  CHECK(near(a.row.external_work, b.row.external_work, work));
  CHECK(near(a.row.surface_energy, b.row.surface_energy, a.row.surface_energy));
  CHECK(near(a.row.crack_length, b.row.crack_length, a.row.crack_length));
  CHECK(std::abs(a.row.released_energy - b.row.released_energy) < 5e-3 * work);  // another mean over the step
  CHECK(std::abs(b.row.energy_residual) <= std::abs(a.row.energy_residual) + 1e-6 * work);
}

}  // namespace

TEST_CASE("assembled and row kernels agree on a breaking plate of an anisotropic material") {
  check_agreement(cracked("shale", 24), 220, 0.9);
}

TEST_CASE("assembled and row kernels agree where the secant law yields") { check_agreement(cracked("steel", 20), 250, 0.01); }

TEST_CASE("assembled and row kernels agree on layers, oblong cells, tractions, ramps and initial motion") {
  Scene scene = square("pbx", 20);
  scene.width *= 1.5;
  scene.layers = {{0.4 * scene.height, *find_material("shale")}, {scene.height, *find_material("pbx")}};
  scene.phase_field.length_scale.kind = LengthScale::Kind::full;
  scene.cracks = {{0.3 * scene.width, 0.1 * scene.height, 0.6 * scene.width, 0.7 * scene.height}};
  SideLoad up = pull(4.0, scene.width), part;
  up.ramp = 1e-5, up.tangential = Tangential::velocity, up.tangential_velocity = 1.0;
  part.from = 0.1 * scene.height, part.to = 0.8 * scene.height, part.traction = {-2e6, 1e6}, part.ramp = 3e-5;
  set_load(scene, Side::top, up);
  set_load(scene, Side::bottom, pull(0.0, scene.width));
  set_load(scene, Side::left, part);
  scene.initial.velocity_gradient = {20.0, 0.0, 5.0, 40.0};
  scene.initial.strain = {1e-5, 2e-5, -1e-5};
  check_agreement(scene, 120, 0.5);
}

TEST_CASE("assembled and row kernels agree with every split, in plane strain and in plane stress") {
  for (const Plane plane : {Plane::strain, Plane::stress})
    for (const Split split : {Split::none, Split::spectral, Split::volumetric_deviatoric, Split::star_convex}) {
      Scene scene = cracked("pbx", 16);
      scene.phase_field.split = split, scene.phase_field.plane = plane;
      INFO(static_cast<int>(split) << " " << static_cast<int>(plane));
      check_agreement(scene, 100, 0.5);
    }
}

TEST_CASE("assembled and row kernels agree with AT1") {
  Scene scene = cracked("pbx", 20);
  scene.phase_field.surface = SurfaceModel::at1;
  check_agreement(scene, 120, 0.5);
}

TEST_CASE("assembled and row kernels agree on cracks seeded as a row of nodes and as a history, with either surface law") {
  for (const CrackSeeding seeding : {CrackSeeding::nodes, CrackSeeding::history})
    for (const SurfaceModel surface : {SurfaceModel::at2, SurfaceModel::at1}) {
      Scene scene = cracked("shale", 16);
      scene.phase_field.crack_seeding = seeding, scene.phase_field.surface = surface;
      check_agreement(scene, 60, 0.3);
    }
}

TEST_CASE("over many steps psi stays as near to its solution as its tolerance and the resting of tiles promise, however wide a crack is") {
  for (const bool rests : {false, true})
    for (const double width : {1.0, 2.0, 3.0, 4.0}) {
      Scene scene = cracked("pbx", 40);
      for (const Side side : {Side::top, Side::bottom}) set_load(scene, side, pull(0.2, scene.width));
      scene.layers[0].material.characteristic_width *= width;
      phasefield::PhaseField<double> run(scene, phasefield::chosen_kernels<double>()), exact(scene, phasefield::chosen_kernels<double>());
      exact.model().damage_tolerance = fine;
      exact.model().rules.work_where_it_moves = false;
      run.model().rules.work_where_it_moves = rests;
      const Apart apart = farthest_apart(run, exact, 0.9 * run.stable_dt(), 600);
      INFO("w_0 is " << width << " cells, after " << apart.steps << " steps");
      CHECK(apart.psi < (rests ? 4e-3 : 5e-4));
    }
}
