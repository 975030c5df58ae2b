// Slopes of the stresses, d sigma / d epsilon, for the implicit schemes: symmetric, in the order xx, zz, gamma. Each is the derivative of
// the stress of the same name in splits.hpp, secant.hpp and j2.hpp.
#pragma once

#include "solver/law/secant.hpp"
#include "solver/law/splits.hpp"

namespace fracfarm::law {

template <class Real>
struct Tangent {
  Real xx_xx, xx_zz, xx_xz, zz_zz, zz_xz, xz_xz;  // Pa
};

template <class Real>
FRACFARM_POINTWISE Tangent<Real> sum(Real a, const Tangent<Real>& p, Real b, const Tangent<Real>& q) {
  return {a * p.xx_xx + b * q.xx_xx, a * p.xx_zz + b * q.xx_zz, a * p.xx_xz + b * q.xx_xz,
          a * p.zz_zz + b * q.zz_zz, a * p.zz_xz + b * q.zz_xz, a * p.xz_xz + b * q.xz_xz};
}

template <class Real>
FRACFARM_POINTWISE Tangent<Real> tangent(const Stiffness<Real>& C) {
  return {C.C11, C.C13, Real(0), C.C33, Real(0), C.C55};
}

// Of bulk tr e 1 + 2 mu dev e - soft d (d : e), with dev e = e - per_dimensions tr e 1.
template <class Real>
struct Isotropic {
  Real bulk, mu, per_dimensions;
  Real soft;                 // Pa
  Real d_xx, d_zz, d_shear;  // d_shear multiplies gamma: half the deviator's gamma

  FRACFARM_POINTWISE Tangent<Real> tangent() const {
    const Real same = bulk + Real(2) * mu * (Real(1) - per_dimensions), other = bulk - Real(2) * mu * per_dimensions;
    return {same - soft * d_xx * d_xx, other - soft * d_xx * d_zz, -soft * d_xx * d_shear,
            same - soft * d_zz * d_zz, -soft * d_zz * d_shear,     mu - soft * d_shear * d_shear};
  }
};

template <class Real>
FRACFARM_POINTWISE Tangent<Real> degraded_tangent(const SeedSplit<Real>& split, const Strain<Real>&) {
  return tangent(split.C);
}
template <class Real>
FRACFARM_POINTWISE Tangent<Real> kept_tangent(const SeedSplit<Real>&, const Strain<Real>&) {
  return {};
}
template <class Real>
FRACFARM_POINTWISE Tangent<Real> degraded_tangent(const NoSplit<Real>& split, const Strain<Real>&) {
  return tangent(split.C);
}
template <class Real>
FRACFARM_POINTWISE Tangent<Real> kept_tangent(const NoSplit<Real>&, const Strain<Real>&) {
  return {};
}

// Second derivatives of lambda/2 <tr e>^2 + mu (<e_1>^2 + <e_2>^2) through mean, half difference a and half shear b of the strains:
// e_1,2 = mean +- r with r^2 = a^2 + b^2. Where r = 0 the direction does not matter, because both principal strains have one sign.
template <class Real>
FRACFARM_POINTWISE Tangent<Real> degraded_tangent(const SpectralSplit<Real>& split, const Strain<Real>& e) {
  const auto p = split.principal(e);
  const bool turned = p.radius > Real(0);
  const Real c = turned ? Real(0.5) * (e.xx - e.zz) / p.radius : Real(1), s = turned ? Real(0.5) * e.xz / p.radius : Real(0);
  const Real first = p.mean + p.radius > Real(0) ? Real(1) : Real(0), second = p.mean - p.radius > Real(0) ? Real(1) : Real(0);
  const Real along = Real(2) * split.mu * (first + second), mixed = Real(2) * split.mu * (first - second);
  const Real slope = Real(2) * split.mu * (positive(p.mean + p.radius) - positive(p.mean - p.radius));
  const Real across = turned ? slope / p.radius : along;
  const Real ma = mixed * c, mb = mixed * s;
  const Real aa = along * c * c + across * s * s, ab = (along - across) * c * s, bb = along * s * s + across * c * c;
  const Real trace = e.xx + e.zz > Real(0) ? split.lambda : Real(0), quarter = Real(0.25);
  return {trace + quarter * (along + Real(2) * ma + aa),
          trace + quarter * (along - aa),
          quarter * (mb + ab),
          trace + quarter * (along - Real(2) * ma + aa),
          quarter * (mb - ab),
          quarter * bb};
}
template <class Real>
FRACFARM_POINTWISE Tangent<Real> kept_tangent(const SpectralSplit<Real>& split, const Strain<Real>& e) {
  const Stiffness<Real> whole{split.lambda + Real(2) * split.mu, split.lambda, split.lambda + Real(2) * split.mu, split.mu};
  return sum(Real(1), tangent(whole), Real(-1), degraded_tangent(split, e));
}

template <class Real>
FRACFARM_POINTWISE Tangent<Real> degraded_tangent(const StarConvexSplit<Real>& split, const Strain<Real>& e) {
  const Real bulk = e.xx + e.zz > Real(0) ? split.bulk : -split.gamma * split.bulk;
  return Isotropic<Real>{bulk, split.mu, split.per_dimensions, Real(0), Real(0), Real(0), Real(0)}.tangent();
}
template <class Real>
FRACFARM_POINTWISE Tangent<Real> kept_tangent(const StarConvexSplit<Real>& split, const Strain<Real>& e) {
  const Real bulk = e.xx + e.zz > Real(0) ? Real(0) : (Real(1) + split.gamma) * split.bulk;
  return {bulk, bulk, Real(0), bulk, Real(0), Real(0)};
}

// Of the secant stress; q in Pa, of the same strain. ds/dq = -(1 - hardening_share) sigma_y / q^2 past yield.
template <class Real>
FRACFARM_POINTWISE Tangent<Real> tangent(const Secant<Real>& law, const Strain<Real>& e, Real q) {
  const Real third = Real(1.0 / 3.0) * (e.xx + e.zz);
  const Real soft =
      q > law.yield ? Real(12) * law.mu * law.mu * law.mu * (Real(1) - law.hardening_share) * law.yield / (q * q * q) : Real(0);
  return Isotropic<Real>{law.bulk, reduction(law, q) * law.mu, Real(1.0 / 3.0), soft, e.xx - third, e.zz - third, Real(0.5) * e.xz}
      .tangent();
}

}  // namespace fracfarm::law
