// Secant plasticity for isotropic metals: von Mises yield with linear hardening as a smaller shear modulus, bulk modulus kept.
// Nonlinear elastic: it has no memory, so unloading retraces loading.
#pragma once

#include <cmath>

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

template <class Real>
struct Secant {
  Real bulk;             // K = lambda + 2/3 mu, Pa
  Real mu;               // Pa
  Real yield;            // sigma_y, Pa
  Real hardening_share;  // H_m / (3 mu + H_m)
};

// K, mu, sigma_y, H_m in Pa.
template <class Real>
FRACFARM_POINTWISE Secant<Real> secant(Real bulk, Real mu, Real yield, Real hardening) {
  return {bulk, mu, yield, hardening / (Real(3) * mu + hardening)};
}

// q^2 = 6 mu^2 e:e with e the deviator of the plane strain; undegraded, Pa^2.
template <class Real>
FRACFARM_POINTWISE Real von_mises_squared(const Secant<Real>& law, const Strain<Real>& e) {
  const Real volume = e.xx + e.zz;
  const Real square = e.xx * e.xx + e.zz * e.zz + Real(0.5) * e.xz * e.xz - volume * volume * (Real(1.0 / 3.0));
  return Real(6.0) * law.mu * law.mu * (square > Real(0.0) ? square : Real(0.0));
}

// s = (sigma_y + H_m dgamma) / q with dgamma = (q - sigma_y) / (3 mu + H_m) past yield, exactly 1 before it.
template <class Real>
FRACFARM_POINTWISE Real reduction(const Secant<Real>& law, Real q) {
  const Real past = q > law.yield ? q : law.yield;
  return (law.yield + law.hardening_share * (past - law.yield)) / past;
}

// Moduli with mu -> s mu and the bulk modulus kept.
template <class Real>
FRACFARM_POINTWISE Stiffness<Real> reduced_stiffness(const Secant<Real>& law, Real s) {
  const Real mu = s * law.mu;
  const Real C11 = law.bulk + Real(4.0 / 3.0) * mu;
  return {C11, law.bulk - Real(2.0 / 3.0) * mu, C11, mu};
}

// Potential of the secant stress, J/m^3, undegraded: 1/2 K tr^2 + integral of q ds over the equivalent strain. It closes the energy ledger.
template <class Real>
FRACFARM_POINTWISE Real stored_energy(const Secant<Real>& law, const Strain<Real>& e, Real q) {
  const Real volume = e.xx + e.zz;
  const Real elastic = q > law.yield ? law.yield : q;
  const Real past = q > law.yield ? q - law.yield : Real(0.0);
  return Real(0.5) * law.bulk * volume * volume +
         (elastic * elastic + Real(2.0) * law.yield * past + law.hardening_share * past * past) / (Real(6.0) * law.mu);
}

}  // namespace fracfarm::law
