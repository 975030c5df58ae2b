// The damage equation is solved to a tolerance: on this sample psi undershot to -5e-36 far from every crack, and the validator refused the
// record of a sound run.
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/scene/pattern.hpp"
#include "solver/solve.hpp"

using namespace fracfarm;

TEST_CASE("damage that leaves its bounds by less than the solve's tolerance is stored as the bound") {
  const SampleChoice sample{find_material("shale"), &named_loads[0], CrackSet::orthogonal, 2026, 106};
  Scene scene = sample_scene(sample);
  scene.phase_field.cells_x = scene.phase_field.cells_z = 63;
  const auto run = solve(scene, {});
  REQUIRE(run);
  const auto bounded = [](const std::vector<float>& field) {
    return std::all_of(field.begin(), field.end(), [](float psi) { return psi >= 0.0f && psi <= 1.0f; });
  };
  for (const Frame& frame : run->frames) CHECK(bounded(frame.damage));
  CHECK(bounded(run->damage_initial));
  CHECK(bounded(run->damage_failure));
}
