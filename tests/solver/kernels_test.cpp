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

bool same_bits(const Field& a, const Field& b) { return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0; }

struct Outcome {
  State state;
  Field force;
  SampleRow sample;
};

Outcome after_steps(const Scene& scene, const Kernels& kernels, int steps) {
  PhaseField run(scene, kernels);
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  for (int n = 0; n < steps; ++n) REQUIRE(run.step(n, dt));
  return {run.state(), run.scratch().fx, run.sample(steps, dt)};
}

}  // namespace

TEST_CASE("every instruction set gives the same bits, elastic and yielding, on widths that fill lanes and that do not") {
  for (const char* material : {"shale", "steel"})
    for (const int cells : {7, 8, 31, 33}) {
      const Scene scene = cracked(material, cells);
      const Outcome expected = after_steps(scene, *runnable_kernels().back(), 150);
      for (const Kernels* kernels : runnable_kernels()) {
        INFO(material << " " << cells << " " << kernels->isa);
        const Outcome found = after_steps(scene, *kernels, 150);
        CHECK(same_bits(expected.state.ux, found.state.ux));
        CHECK(same_bits(expected.state.vz, found.state.vz));
        CHECK(same_bits(expected.state.psi, found.state.psi));
        CHECK(same_bits(expected.state.history[3], found.state.history[3]));
        CHECK(same_bits(expected.force, found.force));
        CHECK(std::memcmp(&expected.sample.stress_zz, &found.sample.stress_zz, sizeof(double)) == 0);
        CHECK(std::memcmp(&expected.sample.kinetic_energy, &found.sample.kinetic_energy, sizeof(double)) == 0);
        CHECK(std::memcmp(&expected.sample.surface_energy, &found.sample.surface_energy, sizeof(double)) == 0);
      }
    }
}

TEST_CASE("the steel of that test does yield") {
  PhaseField run(cracked("steel", 31), chosen_kernels());
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  int yielding = 0;
  for (int n = 0; n < 150; ++n) {
    REQUIRE(run.step(n, dt));
    for (const unsigned char row : run.scratch().row_yields) yielding += row;
  }
  CHECK(yielding > 0);
}

TEST_CASE("the environment forces a lower path, and a word that names none is no path") {
  for (const Kernels* kernels : runnable_kernels()) {
    ::setenv("FRACFARM_ISA", std::string(kernels->isa).c_str(), 1);
    CHECK(&chosen_kernels() == kernels);
    CHECK(PhaseField(square("pbx", 4), chosen_kernels()).kernel() == std::string(kernels->isa) + "/double");
  }
  ::setenv("FRACFARM_ISA", "mmx", 1);
  CHECK(&chosen_kernels() == runnable_kernels().front());
  ::unsetenv("FRACFARM_ISA");
}

TEST_CASE("the mean stress of a held, strained plate is Hooke's to rounding, and its force balances") {
  Scene scene = square("shale", 13);
  scene.initial.strain = {1e-4, -2e-5, 3e-5};
  scene.phase_field.residual_stiffness = 0.0;
  scene.layers[0].material.Gc = 1e12;  // no damage
  PhaseField run(scene, chosen_kernels());
  REQUIRE(run.start(0.5 * run.stable_dt()));
  const Elasticity C = scene.layers[0].material.elasticity;
  const SampleRow s = run.sample(0, 1e-7);
  CHECK(s.stress_xx == Approx(C.C11 * 1e-4 - C.C13 * 2e-5).epsilon(1e-9));
  CHECK(s.stress_zz == Approx(C.C13 * 1e-4 - C.C33 * 2e-5).epsilon(1e-9));
  const double energy = 0.5 * (C.C11 * 1e-8 - 2 * C.C13 * 2e-9 + C.C33 * 4e-10 + C.C55 * 4 * 9e-10);
  CHECK(s.elastic_energy == Approx(energy * scene.width * scene.height).epsilon(1e-9));
  double sum = 0.0, largest = 0.0;
  for (const double f : run.scratch().fx) sum += f, largest = std::max(largest, std::abs(f));
  CHECK(std::abs(sum) < 1e-10 * largest);
}
