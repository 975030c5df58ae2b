// A joint between two triangles at one of its points: traction from opening, and damage that never heals. Below its strength it is a spring
// of the same penalty in every direction; past it both parts of the opening soften along one curve and unload along the secant (Munjiza,
// Andrews and White, 1999; Mahabadi, Lisjak, Munjiza and Grasselli, 2012). Compression is not damaged.
//   lambda = |(dn+/d0n, dt/d0t)|, d = |(dn+/dnc, dt/dtc)|, r = d / lambda;  D = max(D, (d - r) / (1 - r)) where lambda > 1
//   t = p delta z(D) r / w,  w = r + D (1 - r): the d at which the joint softens on, so that D grows where d > w and nowhere else
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

// lambda^2 and d^2; of an opening that was scaled, times the square of that scale.
template <class Real>
struct Extent {
  Real onset, rupture;
};

template <class Real>
FRACFARM_POINTWISE Extent<Real> extent(const Joint<Real>& law, const Opening<Real>& opening) {
  const Real open = larger(opening.n, Real(0)), n = open * open, t = opening.t * opening.t;
  const Real onset_n = law.per_onset_n * law.per_onset_n, onset_t = law.per_onset_t * law.per_onset_t;
  const Real rupture_n = law.per_rupture_n * law.per_rupture_n, rupture_t = law.per_rupture_t * law.per_rupture_t;
  return {n * onset_n + t * onset_t, n * rupture_n + t * rupture_t};
}

// r, which the size of the opening does not change; 1 where there is none.
template <class Real>
FRACFARM_POINTWISE Real brittleness(const Extent<Real>& extent) {
  const auto opens = extent.onset > Real(1e-30);
  return sqrt(select(opens, extent.rupture, Real(1)) / select(opens, extent.onset, Real(1)));
}

// z of a damage.
template <class Curve, class Real>
FRACFARM_POINTWISE Real kept(Real D) {
  return select(D > Real(0), Curve::kept(D), Real(1));
}

// w of a damage, and the damage that an opening d beyond w leaves; a joint without a softening branch (r of 1 or more) breaks.
template <class Real>
FRACFARM_POINTWISE Real level(Real r, Real D) {
  return r + D * (Real(1) - r);
}
template <class Real>
FRACFARM_POINTWISE Real grown(Real r, Real d, Real D) {
  const Real one(1), branch = one - r;
  return select(branch > Real(0), larger(D, smaller((d - r) / select(branch > Real(0), branch, one), one)), one);
}

// Opening at which a joint is broken, m: the work to break it is `toughness` (J/m^2) exactly, with the elastic part before its strength.
inline double rupture_opening(double penalty, double strength, double toughness, double area) {
  const double onset = strength / penalty;
  return onset + (toughness - 0.5 * strength * onset) / (strength * area);
}

template <class Curve, class Real>
FRACFARM_POINTWISE JointAnswer<Real> answer(const Joint<Real>& law, const Opening<Real>& opening, Real D) {
  const Extent<Real> size = extent(law, opening);
  const Real r = brittleness(size), before = level(r, D);
  const Real damage = select(size.rupture > before * before, grown(r, sqrt(size.rupture), D), D);
  const Real soft = law.penalty * (kept<Curve>(damage) * r / level(r, damage));
  return {damage, select(opening.n > Real(0), soft, law.penalty) * opening.n, soft * opening.t};
}

}  // namespace fracfarm::law
