#include "solver/phasefield/kernels.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <cstring>

#include "solver/phasefield/phase_field.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using namespace fracfarm::phasefield;

namespace {

template <class Real>
bool same_bits(const Field<Real>& a, const Field<Real>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <class Real>
struct Outcome {
  State<Real> state;
  Field<Real> force;
  SampleRow sample;
};

template <class Real>
Outcome<Real> after_steps(const Scene& scene, const Kernels<Real>& kernels, int steps) {
  PhaseField<Real> run(scene, kernels);
  run.model().keeps_forces = true;
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  for (int n = 0; n < steps; ++n) REQUIRE(run.step(n, dt));
  return {run.state(), run.scratch().fx, run.sample(steps, dt)};
}

template <class Real>
void check_paths(const Scene& scene) {
  const Outcome<Real> expected = after_steps(scene, *runnable_kernels<Real>().back(), 150);
  for (const Kernels<Real>* kernels : runnable_kernels<Real>()) {
    INFO(kernels->isa << (sizeof(Real) == 8 ? " double" : " float"));
    const Outcome<Real> found = after_steps(scene, *kernels, 150);
    CHECK(same_bits(expected.state.ux, found.state.ux));
    CHECK(same_bits(expected.state.vz, found.state.vz));
    CHECK(same_bits(expected.state.psi, found.state.psi));
    CHECK(same_bits(expected.state.history[3], found.state.history[3]));
    CHECK(same_bits(expected.force, found.force));
    CHECK(same_bits(expected.sample.stress_zz, found.sample.stress_zz));
    CHECK(same_bits(expected.sample.kinetic_energy, found.sample.kinetic_energy));
    CHECK(same_bits(expected.sample.elastic_energy, found.sample.elastic_energy));
    CHECK(same_bits(expected.sample.released_energy, found.sample.released_energy));
    CHECK(same_bits(expected.sample.surface_energy, found.sample.surface_energy));
  }
}

}  // namespace

TEST_CASE("every instruction set gives the same bits, elastic and yielding, on widths that fill lanes and that do not") {
  for (const char* material : {"shale", "steel"})
    for (const int cells : {7, 15, 31, 33}) {
      INFO(material << " " << cells);
      check_paths<double>(cracked(material, cells));
      check_paths<float>(cracked(material, cells));
    }
}

TEST_CASE("every instruction set gives the same bits with every split") {
  for (const Split split : {Split::none, Split::spectral, Split::volumetric_deviatoric, Split::star_convex}) {
    Scene scene = cracked("pbx", 21);
    scene.phase_field.split = split;
    INFO(static_cast<int>(split));
    check_paths<double>(scene);
    check_paths<float>(scene);
  }
}

TEST_CASE("the steel of that test does yield") {
  PhaseField<double> run(cracked("steel", 31), chosen_kernels<double>());
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  int yielding = 0;
  for (int n = 0; n < 150; ++n) {
    REQUIRE(run.step(n, dt));
    for (const unsigned char tile : run.state().yields) yielding += tile == does_yield;
  }
  CHECK(yielding > 0);
}

TEST_CASE("the environment forces a lower path, and a word that names none is no path") {
  const Scene scene = square("pbx", 4);
  for (const Kernels<double>* kernels : runnable_kernels<double>()) {
    ::setenv("FRACFARM_ISA", std::string(kernels->isa).c_str(), 1);
    CHECK(&chosen_kernels<double>() == kernels);
    CHECK(PhaseField<double>(scene, chosen_kernels<double>()).kernel() == std::string(kernels->isa) + "/double");
    CHECK(PhaseField<float>(scene, chosen_kernels<float>()).kernel() == std::string(kernels->isa) + "/float");
  }
  ::setenv("FRACFARM_ISA", "mmx", 1);
  CHECK(&chosen_kernels<double>() == runnable_kernels<double>().front());
  ::unsetenv("FRACFARM_ISA");
}

TEST_CASE("the mean stress of a held, strained plate is Hooke's to rounding, and its force balances") {
  Scene scene = square("shale", 13);
  scene.initial.strain = {1e-4, -2e-5, 3e-5};
  scene.phase_field.residual_stiffness = 0.0;
  scene.layers[0].material.Gc = 1e12;  // no damage
  PhaseField<double> run(scene, chosen_kernels<double>());
  run.model().keeps_forces = true;
  REQUIRE(run.start(0.5 * run.stable_dt()));
  const Elasticity C = scene.layers[0].material.elasticity;
  const SampleRow s = run.sample(0, 1e-7);
  CHECK(s.stress_xx == Approx(C.C11 * 1e-4 - C.C13 * 2e-5).epsilon(1e-9));
  CHECK(s.stress_zz == Approx(C.C13 * 1e-4 - C.C33 * 2e-5).epsilon(1e-9));
  const double energy = 0.5 * (C.C11 * 1e-8 - 2 * C.C13 * 2e-9 + C.C33 * 4e-10 + C.C55 * 4 * 9e-10);
  CHECK(s.elastic_energy == Approx(energy * scene.width * scene.height).epsilon(1e-9));
  double sum = 0.0, largest = 0.0;
  for (int j = 0; j <= 13; ++j)
    for (int i = 0; i <= 13; ++i) {
      const double f = run.scratch().fx[run.model().grid.index(i, j)];
      sum += f, largest = std::max(largest, std::abs(f));
    }
  CHECK(std::abs(sum) < 1e-10 * largest);
}
