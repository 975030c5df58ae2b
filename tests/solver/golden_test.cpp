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
  list.push_back({"shale", cracked("shale", 40), "88d9642f073d86a1a43fcae93ddb29e9", "0d7fdd7a9797832a06c7ac7c101bfd01"});
  list.push_back({"steel, yielding", cracked("steel", 24), "5a97e40c21c63b60e86b20fe718f8ece", "b4fec84fed81e1b06b4a33f6ef041135"});
  list.push_back({"layers, traction", layered(), "02d28cfb69342e4fb75e244dfb8a779a", "cb8ae8d15df9a68440cbcedaf3e0d14b"});
  list.push_back({"spectral, AT1",
                  with(cracked("pbx", 24),
                       [](Scene& scene) { scene.phase_field.split = Split::spectral, scene.phase_field.surface = SurfaceModel::at1; }),
                  "cc90b8d2256d25293b537693c37f5494", "0c934c061a206c2647a0d663d0c86834"});
  list.push_back({"star-convex, plane stress",
                  with(cracked("pbx", 33),
                       [](Scene& scene) { scene.phase_field.split = Split::star_convex, scene.phase_field.plane = Plane::stress; }),
                  "1a46d4e8777bd7a1229e37138cc66fa4", "287d1fc703b8e494ce4a17c8669b94d0"});
  list.push_back(
      {"no split, history",
       with(cracked("pbx", 24),
            [](Scene& scene) { scene.phase_field.split = Split::none, scene.phase_field.crack_seeding = CrackSeeding::history; }),
       "2daebd8012ab0961f00474ae364a6ea5", "998d9631e8d7cab2080fe032f8e23fb0"});
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
