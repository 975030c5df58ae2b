// A joint between two triangles at one of its points: traction from opening, and damage that never heals. Below its strength it is a spring
// of the same penalty in every direction; past it both parts of the opening soften along one curve and unload along the secant (Munjiza,
// Andrews and White, 1999; Mahabadi, Lisjak, Munjiza and Grasselli, 2012). Compression is not damaged.
//   lambda = |(dn+/d0n, dt/d0t)|, d = |(dn+/dnc, dt/dtc)|, r = d / lambda;  D = max(D, (d - r) / (1 - r)) where lambda > 1
//   t = p delta z(D) r / (r + D (1 - r))
#pragma once

#include "solver/law/softening.hpp"

namespace fracfarm::law {

template <class Real>
struct Joint {
  Real penalty;                       // p, Pa/m
  Real per_onset_n, per_onset_t;      // 1/d0n, 1/d0t, 1/m
  Real per_rupture_n, per_rupture_t;  // 1/dnc, 1/dtc, 1/m
};

template <class Real>
struct Opening {
  Real n, t;  // m: across (positive where it opens) and along the joint
};

template <class Real>
struct JointAnswer {
  Real damage;
  Real normal, shear;  // traction, Pa
};

// Opening at which a joint is broken, m: the work to break it is `toughness` (J/m^2) exactly, with the elastic part before its strength.
inline double rupture_opening(double penalty, double strength, double toughness, double area) {
  const double onset = strength / penalty;
  return onset + (toughness - 0.5 * strength * onset) / (strength * area);
}

template <class Curve, class Real>
FRACFARM_POINTWISE JointAnswer<Real> answer(const Joint<Real>& law, const Opening<Real>& opening, Real D) {
  const Real zero(0), one(1);
  const Real open = larger(opening.n, zero);
  const Real onset_n = open * law.per_onset_n, onset_t = opening.t * law.per_onset_t;
  const Real rupture_n = open * law.per_rupture_n, rupture_t = opening.t * law.per_rupture_t;
  const Real lambda = sqrt(onset_n * onset_n + onset_t * onset_t), d = sqrt(rupture_n * rupture_n + rupture_t * rupture_t);
  // (d - r) / (1 - r) = d (lambda - 1) / (lambda - d) and r / (r + D (1 - r)) = d / (d + D (lambda - d)): one division each.
  const Real gap = lambda - d;
  const Real reached = smaller(d * (lambda - one) / select(gap > zero, gap, one), one);
  const Real damage = select(lambda > one, larger(D, reached), D);
  const Real rest = d + damage * gap;
  const Real share = select(damage > zero, Curve::kept(damage) * d / select(rest > zero, rest, one), one);
  const Real soft = law.penalty * share;
  return {damage, select(opening.n > zero, soft, law.penalty) * opening.n, soft * opening.t};
}

}  // namespace fracfarm::law
