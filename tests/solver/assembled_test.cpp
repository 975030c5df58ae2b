// The assembled path where the rows have nothing to say: integrators, Gauss quadrature, J2, and its own checkpoints.
#include "solver/phasefield/assembled/assembled.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "solver/phasefield/assembled/points.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using phasefield::assembled::Assembled;

namespace {

Scene with(Scene scene, Integrator integrator, double cfl = 0.9) {
  scene.phase_field.integrator = integrator;
  scene.phase_field.cfl = cfl;
  return scene;
}

RunResult run(const Scene& scene) {
  const auto result = solve(scene, {});
  if (!result) FAIL(result.error().message);
  return *result;
}

double last(const RunResult& result, std::string_view column) { return result.series[column].back(); }

// A cracked plate pulled quasi-statically through its peak.
Scene slow(std::string_view material, int cells, Split split) {
  Scene scene = with(cracked(material, cells), Integrator::quasi_static);
  scene.phase_field.split = split;
  scene.phase_field.dt = 4e-7;
  return scene;
}

struct Bytes {
  std::string state;
  SampleRow row;
};

Bytes bytes_after(Assembled& simulation, long long first, long long last_step, double dt) {
  for (long long n = first; n < last_step; ++n) REQUIRE(simulation.step(n, dt));
  ArchiveWriter archive;
  simulation.save(archive);
  return {archive.bytes(), simulation.sample(last_step, dt)};
}

// The state after `steps` steps is the same to the last bit when the run was saved and loaded again in the middle.
void check_resume(const Scene& scene, long long middle, long long steps) {
  Assembled whole(scene), one(scene), two(scene);
  const double dt = scene.phase_field.dt.value_or(scene.phase_field.cfl * whole.stable_dt());
  REQUIRE(whole.start(dt));
  REQUIRE(one.start(dt));
  const Bytes expected = bytes_after(whole, 0, steps, dt), half = bytes_after(one, 0, middle, dt);
  ArchiveReader archive(half.state);
  REQUIRE(two.load(archive, middle, dt));
  CHECK(archive.finished());
  const Bytes found = bytes_after(two, middle, steps, dt);
  CHECK(found.state == expected.state);
  CHECK(found.row.stress_zz == expected.row.stress_zz);
  CHECK(found.row.released_energy == expected.row.released_energy);
  CHECK(found.row.energy_residual == expected.row.energy_residual);
}

}  // namespace

TEST_CASE("Newmark breaks a plate as central differences do, and its ledger closes better") {
  const RunResult rows = run(cracked("pbx", 30)), newmark = run(with(cracked("pbx", 30), Integrator::newmark, 2.0));
  CHECK(newmark.kernel == "assembled/double");
  REQUIRE(newmark.judgement.time_to_failure);
  CHECK(*newmark.judgement.time_to_failure == Approx(*rows.judgement.time_to_failure).epsilon(0.02));
  CHECK(newmark.peak_stress == Approx(rows.peak_stress).epsilon(0.02));
  CHECK(newmark.energy_residual < rows.energy_residual);
  CHECK(newmark.energy_residual < 1e-4);
}

TEST_CASE("a single staggered pass lags the load and strengthens the body, iterated passes do not") {
  const auto peak = [](Integrator integrator, double cfl, int passes) {
    Scene scene = with(cracked("pbx", 24), integrator, cfl);
    for (const Side side : {Side::bottom, Side::top}) scene.loads[static_cast<std::size_t>(side)][0].normal_velocity = 0.5;
    scene.phase_field.staggered_passes = passes;
    Assembled simulation(scene);  // no time loop: it would stop the single pass for its open ledger
    const double dt = cfl * simulation.stable_dt();
    REQUIRE(simulation.start(dt));
    double largest = 0.0;
    for (int n = 0; n * dt < 2e-4; ++n) {
      REQUIRE(simulation.step(n, dt));
      largest = std::max(largest, simulation.mean_stress_zz());
    }
    return largest;
  };
  const double fine = peak(Integrator::explicit_central, 0.9, 1);
  CHECK(peak(Integrator::newmark, 4.0, 100) == Approx(fine).epsilon(0.015));
  CHECK(peak(Integrator::newmark, 4.0, 1) > 1.02 * fine);
}

TEST_CASE("a quasi-static run has no kinetic energy, its ledger closes until the crack jumps, and the jump ends no run") {
  const RunResult result = run(slow("pbx", 20, Split::none));
  CHECK(result.judgement.verdict == Verdict::failed);
  const auto kinetic = result.series["kinetic_energy"], residual = result.series["energy_residual"], work = result.series["external_work"];
  CHECK(*std::max_element(kinetic.begin(), kinetic.end()) == 0.0);
  const auto stress = result.series["stress_zz"];
  const auto peak = std::max_element(stress.begin(), stress.end()) - stress.begin();
  REQUIRE(peak > 2);
  CHECK(std::abs(residual[static_cast<std::size_t>(peak - 1)]) < 1e-3 * work[static_cast<std::size_t>(peak - 1)]);
  CHECK(stress.back() < 0.2 * result.peak_stress);
}

TEST_CASE("a quasi-static bar is in balance: both ends react alike, and with Young's modulus") {
  Scene scene = with(pulled("pbx", 8), Integrator::quasi_static);
  scene.layers[0].material.Gc = 1e15;
  scene.phase_field.dt = 1e-6;
  scene.phase_field.split = Split::spectral;
  scene.phase_field.plane = Plane::stress;
  Assembled bar(scene);
  REQUIRE(bar.start(1e-6));
  for (int n = 0; n < 3; ++n) REQUIRE(bar.step(n, 1e-6));
  const SampleRow row = bar.sample(3, 1e-6);
  const double strain = 2.0 * 3e-6 / scene.height;
  CHECK(row.reaction[3] == Approx(1e10 * strain).epsilon(1e-7));
  CHECK(row.reaction[2] == Approx(row.reaction[3]).epsilon(1e-7));
  CHECK(std::abs(row.stress_xx) < 1e-6 * row.stress_zz);
}

TEST_CASE("tractions in balance stretch a body that nothing holds, tractions out of balance are told") {
  Scene scene = with(square("pbx", 6), Integrator::quasi_static);
  SideLoad up, down;
  up.to = down.to = scene.width;
  up.traction = {0.0, 1e6}, down.traction = {0.0, -1e6};
  set_load(scene, Side::top, up);
  set_load(scene, Side::bottom, down);
  Assembled balanced(scene);
  REQUIRE(balanced.start(1e-6));
  REQUIRE(balanced.step(0, 1e-6));
  CHECK(balanced.mean_stress_zz() == Approx(1e6).epsilon(1e-4));
  set_load(scene, Side::bottom, up);
  Assembled pushed(scene);
  REQUIRE(pushed.start(1e-6));
  const auto step = pushed.step(0, 1e-6);
  REQUIRE_FALSE(step);
  CHECK(step.error().message.find("not in balance") != std::string::npos);
}

TEST_CASE("told displacements move their nodes and give their reactions") {
  Scene scene = with(square("pbx", 6), Integrator::quasi_static);
  phasefield::assembled::Prescription corners;
  for (int i = 0; i <= 6; ++i) corners.told.push_back({i, 0, Axis::z}), corners.told.push_back({i, 6, Axis::z});
  corners.displacement = [](std::size_t k, double time) { return k % 2 ? time : 0.0; };
  Assembled plate(scene, corners);
  REQUIRE(plate.start(1e-6));
  REQUIRE(plate.step(0, 1e-6));
  CHECK(plate.state().u[2 * plate.model().node(3, 6) + 1] == 1e-6);
  double top = 0.0, bottom = 0.0;
  for (int i = 0; i <= 6; ++i) top += plate.reaction(i, 6, Axis::z), bottom += plate.reaction(i, 0, Axis::z);
  CHECK(top > 0.0);
  CHECK(top == Approx(-bottom).epsilon(1e-7));
  CHECK(top == Approx(plate.mean_stress_zz() * scene.width).epsilon(1e-6));
}

TEST_CASE("Gauss quadrature comes as close to the corner points' waves as the grid is fine, and keeps psi within its bounds") {
  const auto stress = [](int cells, Quadrature quadrature) {
    Scene scene = pulled("pbx", cells);
    scene.layers[0].material.Gc = 1e15;
    scene.width = scene.height = 0.05;
    scene.horizon = 2e-5;
    SideLoad& top = scene.loads[static_cast<std::size_t>(Side::top)][0];
    top.ramp = scene.loads[static_cast<std::size_t>(Side::bottom)][0].ramp = 1e-5;
    scene.phase_field.quadrature = quadrature;
    return last(run(scene), "stress_zz");
  };
  const double coarse = std::abs(stress(12, Quadrature::gauss) / stress(12, Quadrature::gll) - 1.0);
  const double fine = std::abs(stress(24, Quadrature::gauss) / stress(24, Quadrature::gll) - 1.0);
  CHECK(coarse < 0.05);
  CHECK(fine < 0.4 * coarse);

  Scene scene = cracked("shale", 24);
  scene.phase_field.quadrature = Quadrature::gauss;
  const RunResult broken = run(scene);
  CHECK(broken.judgement.verdict == Verdict::failed);
  CHECK(broken.energy_residual < 0.005);

  Assembled simulation(scene);  // w_0 is half a cell: the operator alone leaves 0...1 here, and heals
  const double dt = 0.9 * simulation.stable_dt();
  REQUIRE(simulation.start(dt));
  double highest = 0.0, healed = 0.0;
  for (int n = 0; n < 200; ++n) {
    const phasefield::assembled::Vector before = simulation.state().psi;
    REQUIRE(simulation.step(n, dt));
    highest = std::max(highest, simulation.state().psi.maxCoeff());
    healed = std::max(healed, (before - simulation.state().psi).maxCoeff());
  }
  CHECK(highest == 1.0);
  CHECK(healed == 0.0);
}

TEST_CASE("a J2 body pays its plastic work, the ledger closes, and a share of that work breaks it sooner") {
  const auto pulled_with = [](PlasticityModel plasticity, double share) {
    Scene scene = pulled("steel", 16, 20.0);
    scene.cracks = {{0.0, 0.503 * scene.height, 0.35 * scene.width, 0.503 * scene.height}};
    scene.phase_field.plasticity = plasticity;
    scene.phase_field.split = Split::volumetric_deviatoric;
    scene.phase_field.plastic_drive = share;
    return run(scene);
  };
  const RunResult elastic = pulled_with(PlasticityModel::none, 0.0), j2 = pulled_with(PlasticityModel::j2, 0.0),
                  driven = pulled_with(PlasticityModel::j2, 0.5);
  CHECK(last(elastic, "plastic_energy") == 0.0);
  CHECK(last(j2, "plastic_energy") > 0.1 * last(j2, "external_work"));
  CHECK(j2.energy_residual < 5e-4);
  CHECK(j2.peak_stress < 0.9 * elastic.peak_stress);
  CHECK(driven.peak_stress < j2.peak_stress);
}

TEST_CASE("all splits carry a plate with both surface models through its failure without inertia") {
  for (const Split split : {Split::none, Split::spectral, Split::volumetric_deviatoric, Split::star_convex})
    for (const SurfaceModel surface : {SurfaceModel::at1, SurfaceModel::at2}) {
      INFO(static_cast<int>(split) << " " << static_cast<int>(surface));
      Scene scene = slow("pbx", 10, split);
      scene.phase_field.surface = surface;
      scene.phase_field.crack_seeding = surface == SurfaceModel::at1 ? CrackSeeding::history : CrackSeeding::slot;
      const RunResult result = run(scene);
      CHECK(result.judgement.verdict == Verdict::failed);
    }
}

TEST_CASE("an assembled run saved and loaded gives the same bits: each integrator, J2, Gauss") {
  check_resume(with(cracked("pbx", 14), Integrator::newmark, 3.0), 17, 40);
  check_resume(slow("pbx", 12, Split::spectral), 14, 24);
  Scene j2 = cracked("steel", 12);
  j2.phase_field.plasticity = PlasticityModel::j2;
  for (SideLoad* load : {&j2.loads[2][0], &j2.loads[3][0]}) load->normal_velocity = 30.0;
  j2.phase_field.quadrature = Quadrature::gauss;
  check_resume(j2, 60, 110);
  check_resume(with(j2, Integrator::newmark, 2.0), 20, 45);
}
