// Table 1 of the seed paper as it stands ("km/m^3" there means kg/m^3), one function a material. Horizons are this project's choice: about
// twice the mean time-to-failure of each material's slower load, so that a sample which still holds then is CENSORED.
#include "common/material/material.hpp"

#include <array>

namespace fracfarm {
namespace {

Material elastic(std::string_view name, double density, double young, double poisson) {
  Material material;
  material.name = name;
  material.density = density;
  material.elasticity = isotropic(young, poisson);
  material.young = young;
  material.poisson = poisson;
  return material;
}

Material pbx() {
  Material material = elastic("pbx", 1.82e3, 1.0e10, 0.36);
  material.Gc = 640.885;
  material.characteristic_width = 0.004;
  material.cohesion = Cohesion{.friction = 0.6, .tensile_strength = 0.5e6, .shear_strength = 2.0e6, .GI = 125, .GII = 500};
  material.default_horizon = 1000e-6;
  material.fdem_horizon = 4000e-6;
  return material;
}

Material shale() {
  Material material;
  material.name = "shale";
  material.density = 2.075e3;
  material.elasticity = {.C11 = 3.125738e10, .C13 = 3.399087e9, .C33 = 2.248732e10, .C55 = 6.486048e9};
  material.Gc = 50;
  material.characteristic_width = 0.002;
  material.cohesion = Cohesion{.friction = 0.6, .tensile_strength = 1.0e7, .shear_strength = 4.0e7, .GI = 100, .GII = 400};
  material.default_horizon = 350e-6;
  return material;
}

Material tungsten() {
  Material material = elastic("tungsten", 19.25e3, 4.0e11, 0.28);
  material.plasticity = Plasticity{.yield = 7.5e8, .hardening = 5.0e9};
  material.Gc = 500;
  material.characteristic_width = 0.002;
  material.cohesion = Cohesion{.friction = 0.6, .tensile_strength = 8.5e8, .shear_strength = 4.905e8, .GI = 12750, .GII = 7358};
  material.default_horizon = 250e-6;
  return material;
}

Material aluminum() {
  Material material = elastic("aluminum", 2.7e3, 6.49e10, 0.25);
  material.plasticity = Plasticity{.yield = 2.5e8, .hardening = 2.5e8};
  material.Gc = 1e4;
  material.characteristic_width = 0.004;
  material.default_horizon = 1200e-6;
  return material;
}

Material steel() {
  Material material = elastic("steel", 7.85e3, 2e11, 0.3);
  material.plasticity = Plasticity{.yield = 6e8, .hardening = 2.5e9};
  material.Gc = 2.5e5;
  material.characteristic_width = 0.004;
  material.default_horizon = 2500e-6;
  return material;
}

// Table 1's PBX breaks at the plates of an FDEM run, not at its cracks (rho c v exceeds its tensile strength); the paper's figure fits
// these strengths. Phase field: the same as pbx.
Material pbx5() {
  Material material = pbx();
  material.name = "pbx5";
  material.cohesion->tensile_strength = 5e6;
  material.cohesion->shear_strength = 20e6;
  return material;
}

}  // namespace

Elasticity isotropic(double young, double poisson) {
  const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  const double mu = young / (2 * (1 + poisson));
  return {.C11 = lambda + 2 * mu, .C13 = lambda, .C33 = lambda + 2 * mu, .C55 = mu};
}

std::span<const Material> material_table() {
  static const std::array<Material, 6> table{pbx(), shale(), tungsten(), aluminum(), steel(), pbx5()};
  return table;
}

const Material* find_material(std::string_view name) {
  for (const Material& material : material_table())
    if (material.name == name) return &material;
  return nullptr;
}

}  // namespace fracfarm
