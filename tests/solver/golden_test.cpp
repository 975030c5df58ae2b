// Golden hashes: short runs whose every number is fixed. They hold for every instruction set that runs here, and for the same sources built
// by clang (clang_bits.sh builds and runs this program with it). A change of the scheme changes them, and then says so in its commit.
#include <catch2/catch.hpp>

#include <cstdlib>

#include "common/base/hash.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

struct Golden {
  const char* name;
  Scene scene;
  const char* in_double;
  const char* in_float;
};

Scene with(Scene scene, void (*change)(Scene&)) {
  change(scene);
  return scene;
}

Scene layered() {
  Scene scene = cracked("pbx", 21);
  scene.width *= 1.3;
  scene.layers = {{0.4 * scene.height, *find_material("aluminum")}, scene.layers[0]};
  scene.phase_field.plasticity = PlasticityModel::secant;
  SideLoad part = pull(0.0, 0.6 * scene.height);
  part.normal_velocity.reset();
  part.traction = {2e6, -1e6};
  part.ramp = 2e-5;
  set_load(scene, Side::right, part);
  return scene;
}

std::vector<Golden> runs() {
  std::vector<Golden> list;
  list.push_back({"shale", cracked("shale", 40), "d32131425ec03cbe764e392d24ccb555", "88f98b9c961d03d4fd1baeb7dafc605d"});
  list.push_back({"steel, yielding", cracked("steel", 24), "dee8b8bc9578bb23b26546751e3700bf", "d55fb3153f4ab586070ed5d9b4322a73"});
  list.push_back({"layers, traction", layered(), "edf35760c55fd41bbc82d33305892e2a", "080ba8e8a1e9983458e1f76b3d63d5b3"});
  list.push_back({"spectral, AT1",
                  with(cracked("pbx", 24),
                       [](Scene& scene) { scene.phase_field.split = Split::spectral, scene.phase_field.surface = SurfaceModel::at1; }),
                  "2f055d217c36ea9e5aad4afade12dcfd", "2f856df63ea1ced8a4211ee244a943e6"});
  list.push_back({"star-convex, plane stress",
                  with(cracked("pbx", 33),
                       [](Scene& scene) { scene.phase_field.split = Split::star_convex, scene.phase_field.plane = Plane::stress; }),
                  "df13b0617ab2f7bb2f9e45b2dae1e869", "a74b8ace806a89181fd5d2ea01a6d428"});
  list.push_back(
      {"no split, history",
       with(cracked("pbx", 24),
            [](Scene& scene) { scene.phase_field.split = Split::none, scene.phase_field.crack_seeding = CrackSeeding::history; }),
       "a00fadf8db177b949476b41e57573008", "81c062df93f69550a7a851b013182e96"});
  return list;
}

// Of the damage field at failure and of the series' physics.
std::string hash_of(Scene scene, Precision precision) {
  scene.phase_field.precision = precision;
  const auto result = solve(scene, {});
  REQUIRE(result);
  std::string bytes(reinterpret_cast<const char*>(result->damage_failure.data()), result->damage_failure.size() * sizeof(float));
  for (const char* name : {"step_time", "stress_xx", "stress_zz", "reaction_top", "kinetic_energy", "elastic_energy", "released_energy",
                           "surface_energy", "external_work", "crack_length"}) {
    const std::span<const double> values = result->series[name];
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  return xxh3_hex(bytes);
}

}  // namespace

TEST_CASE("golden hashes hold on every instruction set, in double and in float") {
  for (const phasefield::Kernels<double>* kernels : phasefield::runnable_kernels<double>()) {
    ::setenv("FRACFARM_ISA", std::string(kernels->isa).c_str(), 1);
    for (const Golden& run : runs()) {
      INFO(run.name << ", " << kernels->isa);
      CHECK(hash_of(run.scene, Precision::double_) == run.in_double);
      CHECK(hash_of(run.scene, Precision::float_) == run.in_float);
    }
  }
  ::unsetenv("FRACFARM_ISA");
}
