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
  list.push_back({"shale", cracked("shale", 40), "92985d76eaa596db6c85c2aada448a64", "c573d3601a35b07d6dc4285887dcbe20"});
  list.push_back({"steel, yielding", cracked("steel", 24), "d18d5b85df28e421fc7f97ae6e53f977", "beecbded9464ac1a81195f3f69e68996"});
  list.push_back({"layers, traction", layered(), "c5a0e1a65da1e9cdd077c1d5d2d62343", "af2b4a7c92ae0632cccd377dd78c7ed5"});
  list.push_back({"spectral, AT1",
                  with(cracked("pbx", 24),
                       [](Scene& scene) { scene.phase_field.split = Split::spectral, scene.phase_field.surface = SurfaceModel::at1; }),
                  "4a77e96085f4ac3fa23b80e314983cdb", "eb5d6297e0738485ea00f874caa2f1e2"});
  list.push_back({"star-convex, plane stress",
                  with(cracked("pbx", 33),
                       [](Scene& scene) { scene.phase_field.split = Split::star_convex, scene.phase_field.plane = Plane::stress; }),
                  "8f9613b460e8393834ffd5455e910f01", "5372d5e3c3a7eef2f67dca4ec229591c"});
  list.push_back(
      {"no split, history",
       with(cracked("pbx", 24),
            [](Scene& scene) { scene.phase_field.split = Split::none, scene.phase_field.crack_seeding = CrackSeeding::history; }),
       "b37ac7180833855c4eb3a5337d7ecb62", "8277ade37f1de8662e1f74f0a7b015f8"});
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
