// The material table (seed paper, Table 1) and what a material is. Data only: laws live in solver/law.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fracfarm {

// Plane-strain stiffness in Voigt notation, z vertical, Pa. sigma_xx = C11 e_xx + C13 e_zz, sigma_zz = C13 e_xx + C33 e_zz, sigma_xz = C55
// gamma_xz.
struct Elasticity {
  double C11 = 0.0;
  double C13 = 0.0;
  double C33 = 0.0;
  double C55 = 0.0;
  bool operator==(const Elasticity&) const = default;
};

// Isotropic plane strain from Young's modulus (Pa) and Poisson's ratio: C11 = lambda + 2 mu, C13 = lambda, C55 = mu.
Elasticity isotropic(double young, double poisson);

struct Plasticity {
  double yield = 0.0;      // sigma_y, Pa (von Mises)
  double hardening = 0.0;  // H_m, Pa
  bool operator==(const Plasticity&) const = default;
};

// Joint properties of FDEM (starred rows of Table 1).
struct Cohesion {
  double friction = 0.0;
  double tensile_strength = 0.0;  // f_t, Pa
  double shear_strength = 0.0;    // f_s, Pa
  double GI = 0.0;                // J/m^2
  double GII = 0.0;               // J/m^2
  bool operator==(const Cohesion&) const = default;
};

struct Material {
  std::string name;      // of the table, or "custom"
  double density = 0.0;  // kg/m^3
  Elasticity elasticity;
  std::optional<double> young;  // as given; canonical text prints young and poisson instead of C where they were given
  std::optional<double> poisson;
  std::optional<Plasticity> plasticity;  // isotropic materials only
  double Gc = 0.0;                       // J/m^2
  double characteristic_width = 0.0;     // m; the text's 2 w_0
  std::optional<Cohesion> cohesion;
  double default_horizon = 1.0e-3;  // s, phase field, CENSORED after it
  double fdem_horizon = 2.0e-3;     // s, the same for FDEM
  bool operator==(const Material&) const = default;
};

// Table 1 in the order pbx, shale, tungsten, aluminum, steel, and pbx5 (pbx with f_t = 5 MPa and f_s = 20 MPa).
std::span<const Material> material_table();

// nullptr where the table has no such name.
const Material* find_material(std::string_view name);

}  // namespace fracfarm
