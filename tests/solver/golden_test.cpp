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
  list.push_back({"shale", cracked("shale", 40), "abd22bd4fcde8a358e4a8919b3cdc025", "d4666e92f63dc5d03b6a83a11697f436"});
  list.push_back({"steel, yielding", cracked("steel", 24), "99da8f3fdd1330a12c0b87f9155e09ef", "dcacd89fa9a7f2ce28d05b0fbaa57134"});
  list.push_back({"layers, traction", layered(), "ef82d32205a5e4bf0671b678c720b701", "bd4b84dbaea36cf907a2b4efa8ac0276"});
  list.push_back({"spectral, AT1",
                  with(cracked("pbx", 24),
                       [](Scene& scene) { scene.phase_field.split = Split::spectral, scene.phase_field.surface = SurfaceModel::at1; }),
                  "d7de494d8b4c9983f05f3d1b05a412df", "e840278a7e68190764831e657285da5e"});
  list.push_back({"star-convex, plane stress",
                  with(cracked("pbx", 33),
                       [](Scene& scene) { scene.phase_field.split = Split::star_convex, scene.phase_field.plane = Plane::stress; }),
                  "fa799b7b2d28ab383bb6e688ac86e176", "029d474301ae75904cad7d6d61f11796"});
  list.push_back(
      {"no split, history",
       with(cracked("pbx", 24),
            [](Scene& scene) { scene.phase_field.split = Split::none, scene.phase_field.crack_seeding = CrackSeeding::history; }),
       "2124b02439d76a07f7eb0533965f96b4", "03ac4906022f37f31730a22276443428"});
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
