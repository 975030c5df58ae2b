// J2 plasticity in plane strain: von Mises yield with linear isotropic hardening on the undegraded stress, radial return (Simo and Hughes,
// 1998, box 3.1), with memory. Isotropic materials only. The plastic strain is traceless, so its out-of-plane part is -(xx + zz).
#pragma once

#include <cmath>

#include "solver/law/splits.hpp"
#include "solver/law/tangent.hpp"

namespace fracfarm::law {

template <class Real>
struct J2 {
  Real bulk, mu, yield, hardening;  // K, mu, sigma_y, H_m, Pa
};

template <class Real>
struct Plastic {
  Real xx, zz, xz;  // plastic strain, xz as gamma
  Real alpha;       // equivalent plastic strain
};

// Elastic strain; y is out of plane.
template <class Real>
struct ElasticStrain {
  Real xx, zz, yy, xz;
};

template <class Real>
FRACFARM_POINTWISE ElasticStrain<Real> elastic_part(const Strain<Real>& e, const Plastic<Real>& p) {
  return {e.xx - p.xx, e.zz - p.zz, p.xx + p.zz, e.xz - p.xz};
}

template <class Real>
FRACFARM_POINTWISE ElasticStrain<Real> deviator(const ElasticStrain<Real>& e) {
  const Real third = (e.xx + e.zz + e.yy) * Real(1.0 / 3.0);
  return {e.xx - third, e.zz - third, e.yy - third, e.xz};
}

// dev e : dev e.
template <class Real>
FRACFARM_POINTWISE Real square(const ElasticStrain<Real>& dev) {
  return dev.xx * dev.xx + dev.zz * dev.zz + dev.yy * dev.yy + Real(0.5) * dev.xz * dev.xz;
}

// q = sqrt(3/2) |s| = sqrt(6) mu |dev e|, Pa.
template <class Real>
FRACFARM_POINTWISE Real von_mises(const J2<Real>& law, const ElasticStrain<Real>& e) {
  return std::sqrt(Real(6) * square(deviator(e))) * law.mu;
}

// From the plastic state `old` at the strain e: dgamma = (q_trial - sigma_y - H_m alpha) / (3 mu + H_m) where that is above 0.
template <class Real>
FRACFARM_POINTWISE Plastic<Real> radial_return(const J2<Real>& law, const Strain<Real>& e, const Plastic<Real>& old) {
  const ElasticStrain<Real> trial = elastic_part(e, old);
  const Real q = von_mises(law, trial), past = q - law.yield - law.hardening * old.alpha;
  if (!(past > Real(0))) return old;
  const ElasticStrain<Real> dev = deviator(trial);
  const Real grown = past / (Real(3) * law.mu + law.hardening), flow = Real(3) * law.mu * grown / q;
  return {old.xx + flow * dev.xx, old.zz + flow * dev.zz, old.xz + flow * dev.xz, old.alpha + grown};
}

// Consistent with the return: d sigma / d e of the undegraded deviatoric stress plus `bulk` tr e.
template <class Real>
FRACFARM_POINTWISE Tangent<Real> consistent_tangent(const J2<Real>& law, const Strain<Real>& e, const Plastic<Real>& old, Real bulk) {
  const ElasticStrain<Real> trial = elastic_part(e, old), dev = deviator(trial);
  const Real q = von_mises(law, trial), limit = law.yield + law.hardening * old.alpha, both = Real(3) * law.mu + law.hardening;
  Isotropic<Real> slope{bulk, law.mu, Real(1.0 / 3.0), Real(0), dev.xx, dev.zz, Real(0.5) * dev.xz};
  if (q > limit) {
    slope.mu *= Real(1) - Real(3) * law.mu * (q - limit) / (both * q);
    slope.soft = Real(36) * law.mu * law.mu * law.mu * law.mu * limit / (both * q * q * q);
  }
  return slope.tangent();
}

// Undegraded plastic work since the start, J/m^3: the stress is on the yield line while alpha grows.
template <class Real>
FRACFARM_POINTWISE Real plastic_work(const J2<Real>& law, const Plastic<Real>& p) {
  return (law.yield + Real(0.5) * law.hardening * p.alpha) * p.alpha;
}

// The seed's drive on elastic strains: all three normal parts clipped at zero, shear whole.
template <class Real>
FRACFARM_POINTWISE Real clipped_energy(const J2<Real>& law, const ElasticStrain<Real>& e) {
  const Real lambda = law.bulk - Real(2.0 / 3.0) * law.mu, x = positive(e.xx), z = positive(e.zz), y = positive(e.yy);
  return Real(0.5) * lambda * (x + y + z) * (x + y + z) + law.mu * (x * x + y * y + z * z + Real(0.5) * e.xz * e.xz);
}

}  // namespace fracfarm::law
