// Secant plasticity for isotropic metals: von Mises yield with linear hardening as a smaller shear modulus, bulk modulus kept.
// Nonlinear elastic: it has no memory, so unloading retraces loading.
#pragma once

#include <cmath>

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

struct Secant {
  double bulk;             // K = lambda + 2/3 mu, Pa
  double mu;               // Pa
  double yield;            // sigma_y, Pa
  double hardening_share;  // H_m / (3 mu + H_m)
};

// K, mu, sigma_y, H_m in Pa.
FRACFARM_POINTWISE Secant secant(double bulk, double mu, double yield, double hardening) {
  return {bulk, mu, yield, hardening / (3.0 * mu + hardening)};
}

// q^2 = 6 mu^2 e:e with e the deviator of the plane strain; undegraded, Pa^2.
FRACFARM_POINTWISE double von_mises_squared(const Secant& law, const Strain& e) {
  const double volume = e.xx + e.zz;
  const double square = e.xx * e.xx + e.zz * e.zz + 0.5 * e.xz * e.xz - volume * volume * (1.0 / 3.0);
  return 6.0 * law.mu * law.mu * (square > 0.0 ? square : 0.0);
}

// s = (sigma_y + H_m dgamma) / q with dgamma = (q - sigma_y) / (3 mu + H_m) past yield, exactly 1 before it.
FRACFARM_POINTWISE double reduction(const Secant& law, double q) {
  const double past = q > law.yield ? q : law.yield;
  return (law.yield + law.hardening_share * (past - law.yield)) / past;
}

// Moduli with mu -> s mu and the bulk modulus kept.
FRACFARM_POINTWISE Stiffness reduced_stiffness(const Secant& law, double s) {
  const double mu = s * law.mu;
  const double C11 = law.bulk + (4.0 / 3.0) * mu;
  return {C11, law.bulk - (2.0 / 3.0) * mu, C11, mu};
}

// Potential of the secant stress, J/m^3, undegraded: 1/2 K tr^2 + integral of q ds over the equivalent strain. It closes the energy ledger.
FRACFARM_POINTWISE double stored_energy(const Secant& law, const Strain& e, double q) {
  const double volume = e.xx + e.zz;
  const double elastic = q > law.yield ? law.yield : q;
  const double past = q > law.yield ? q - law.yield : 0.0;
  return 0.5 * law.bulk * volume * volume +
         (elastic * elastic + 2.0 * law.yield * past + law.hardening_share * past * past) / (6.0 * law.mu);
}

}  // namespace fracfarm::law
