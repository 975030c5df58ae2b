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
  list.push_back({"shale", cracked("shale", 40), "7a7a724113e09e64768d3e7c517b7533", "bdce1b4a69c442479e4f7e1694c24761"});
  list.push_back({"steel, yielding", cracked("steel", 24), "78408590edaa50413322c26912c96511", "9558704b4d24c7e0ef1277f35b660685"});
  list.push_back({"layers, traction", layered(), "0e55e1d7292f67a79a9fd5feb108dad1", "8fa66270c4f54ec529f4b6a186aa7b93"});
  list.push_back({"spectral, AT1",
                  with(cracked("pbx", 24),
                       [](Scene& scene) { scene.phase_field.split = Split::spectral, scene.phase_field.surface = SurfaceModel::at1; }),
                  "dc04e8a30f06897f1fab4e8e270e75b5", "01fea899c08a4ad1659ff8be0ad51bf0"});
  list.push_back({"star-convex, plane stress",
                  with(cracked("pbx", 33),
                       [](Scene& scene) { scene.phase_field.split = Split::star_convex, scene.phase_field.plane = Plane::stress; }),
                  "2e637a28537693f9a71af38e5051dd4e", "30473cb46aaac510ef9d79258580bd17"});
  list.push_back(
      {"no split, history",
       with(cracked("pbx", 24),
            [](Scene& scene) { scene.phase_field.split = Split::none, scene.phase_field.crack_seeding = CrackSeeding::history; }),
       "faa4a19626b944e53d91ca6c00ba0c17", "00f96892969200e63ed0f07c929b8ede"});
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
