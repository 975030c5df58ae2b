// The material table against the seed paper's Table 1, and against wave figures that were computed from it independently.
#include "common/material/material.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace fracfarm;

namespace {

const Material& row(std::string_view name) {
  const Material* material = find_material(name);
  REQUIRE(material);
  return *material;
}

// One row of Table 1; 0 stands for a dash.
struct TableRow {
  std::string_view name;
  double density, young, poisson, C11, C13, C33, C55, yield, hardening, Gc, width, friction, tensile, shear, GI, GII;
};

const std::vector<TableRow> table_1{
    {"pbx", 1820, 1e10, 0.36, 0, 0, 0, 0, 0, 0, 640.885, 0.004, 0.6, 0.5e6, 2e6, 125, 500},
    {"shale", 2075, 0, 0, 3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9, 0, 0, 50, 0.002, 0.6, 1e7, 4e7, 100, 400},
    {"tungsten", 19250, 4e11, 0.28, 0, 0, 0, 0, 7.5e8, 5e9, 500, 0.002, 0.6, 8.5e8, 4.905e8, 12750, 7358},
    {"aluminum", 2700, 6.49e10, 0.25, 0, 0, 0, 0, 2.5e8, 2.5e8, 1e4, 0.004, 0, 0, 0, 0, 0},
    {"steel", 7850, 2e11, 0.3, 0, 0, 0, 0, 6e8, 2.5e9, 2.5e5, 0.004, 0, 0, 0, 0, 0},
};

}  // namespace

TEST_CASE("the table holds every number of the seed paper's Table 1") {
  for (const TableRow& expected : table_1) {
    INFO(expected.name);
    const Material& material = row(expected.name);
    CHECK(material.density == expected.density);
    CHECK(material.young.value_or(0) == expected.young);
    CHECK(material.poisson.value_or(0) == expected.poisson);
    if (expected.C11 > 0) CHECK(material.elasticity == Elasticity{expected.C11, expected.C13, expected.C33, expected.C55});
    CHECK(material.plasticity.value_or(Plasticity{}) == Plasticity{expected.yield, expected.hardening});
    CHECK(material.Gc == expected.Gc);
    CHECK(material.characteristic_width == expected.width);
    const Cohesion cohesion = material.cohesion.value_or(Cohesion{});
    CHECK(cohesion == Cohesion{expected.friction, expected.tensile, expected.shear, expected.GI, expected.GII});
  }
}

TEST_CASE("the table is in the paper's order, with pbx5 after it") {
  std::vector<std::string> names;
  for (const Material& material : material_table()) names.push_back(material.name);
  CHECK(names == std::vector<std::string>{"pbx", "shale", "tungsten", "aluminum", "steel", "pbx5"});
}

TEST_CASE("pbx5 is pbx with ten times its strengths and nothing else changed") {
  Material expected = row("pbx");
  expected.name = "pbx5";
  expected.cohesion->tensile_strength = 5e6;
  expected.cohesion->shear_strength = 20e6;
  CHECK(row("pbx5") == expected);
}

TEST_CASE("a name that is not in the table finds nothing") {
  CHECK(find_material("PBX") == nullptr);
  CHECK(find_material("") == nullptr);
}

TEST_CASE("isotropic stiffness gives Young's modulus and Poisson's ratio back") {
  const Elasticity c = isotropic(2e11, 0.3);
  const double nu = c.C13 / (c.C11 + c.C13);
  CHECK(nu == Approx(0.3).epsilon(1e-14));
  CHECK(2 * c.C55 * (1 + nu) == Approx(2e11).epsilon(1e-14));
  CHECK(c.C11 == c.C33);
}

// Stability edge h / sqrt((C_max + C55) / rho) at h = 0.25 m / 127, and impedance rho c v at 1 m/s, from an independent reference code.
TEST_CASE("the table gives the stability edges and impedances of the reference code") {
  struct Wave {
    std::string_view name;
    double edge_ns, impedance_MPa;
  };
  for (const Wave& wave : {Wave{"pbx", 586.8, 5.53}, Wave{"shale", 461.6, 6.83}, Wave{"tungsten", 334.3, 99.2},
                           Wave{"aluminum", 317.4, 14.5}, Wave{"steel", 296.4, 46.0}}) {
    INFO(wave.name);
    const Material& material = row(wave.name);
    const Elasticity& c = material.elasticity;
    CHECK(0.25 / 127 / std::sqrt((std::max(c.C11, c.C33) + c.C55) / material.density) * 1e9 == Approx(wave.edge_ns).margin(0.06));
    CHECK(std::sqrt(material.density * c.C33) / 1e6 == Approx(wave.impedance_MPa).epsilon(2e-3));
  }
}

TEST_CASE("every material of the table is positive definite and has a horizon") {
  for (const Material& material : material_table()) {
    INFO(material.name);
    const Elasticity& c = material.elasticity;
    CHECK((c.C11 > 0 && c.C33 > 0 && c.C55 > 0 && c.C11 * c.C33 > c.C13 * c.C13));
    CHECK((material.default_horizon >= 250e-6 && material.default_horizon <= 2500e-6));
  }
}
