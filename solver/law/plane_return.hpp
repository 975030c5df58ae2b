// The radial return of j2.hpp without branches, for many points at once: the same equations (Simo and Hughes, 1998, box 3.1).
#pragma once

#include "solver/law/branchless.hpp"
#include "solver/law/j2.hpp"

namespace fracfarm::law {

template <class Real>
struct PlaneReturn {
  Plastic<Real> plastic;
  Stress<Real> stress;  // Pa, in the plane
  Real stored;          // J/m^3, elastic energy
};

// 6 mu^2 dev e : dev e, Pa^2.
template <class Real>
FRACFARM_POINTWISE Real von_mises_square(const J2<Real>& law, const ElasticStrain<Real>& e) {
  return Real(6) * square(deviator(e)) * (law.mu * law.mu);
}

// True where the trial stress of e from the plastic state `old` is past yield.
template <class Real>
FRACFARM_POINTWISE auto yields(const J2<Real>& law, const Strain<Real>& e, const Plastic<Real>& old) {
  const Real limit = law.yield + law.hardening * old.alpha;
  return von_mises_square(law, elastic_part(e, old)) > limit * limit;
}

template <class Real>
FRACFARM_POINTWISE Plastic<Real> flow(const J2<Real>& law, const Strain<Real>& e, const Plastic<Real>& old) {
  const ElasticStrain<Real> trial = elastic_part(e, old), dev = deviator(trial);
  const Real square_q = von_mises_square(law, trial), limit = law.yield + law.hardening * old.alpha;
  const auto flows = square_q > limit * limit;
  const Real q = sqrt(select(flows, square_q, limit * limit));
  const Real grown = select(flows, (q - limit) / (Real(3) * law.mu + law.hardening), Real(0)), share = Real(3) * law.mu * grown / q;
  return {old.xx + share * dev.xx, old.zz + share * dev.zz, old.xz + share * dev.xz, old.alpha + grown};
}

// Stress and stored energy of the elastic part.
template <class Real>
FRACFARM_POINTWISE PlaneReturn<Real> response(const J2<Real>& law, const Strain<Real>& e, const Plastic<Real>& plastic) {
  const ElasticStrain<Real> inside = elastic_part(e, plastic), dev = deviator(inside);
  const Real volume = inside.xx + inside.zz + inside.yy, pressure = law.bulk * volume, twice = Real(2) * law.mu;
  return {plastic,
          {pressure + twice * dev.xx, pressure + twice * dev.zz, law.mu * dev.xz},
          Real(0.5) * pressure * volume + law.mu * square(dev)};
}

}  // namespace fracfarm::law
