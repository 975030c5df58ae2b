// Splits: which part of the stored energy drives damage, which part damage takes away, and the stress of each. With g the degradation,
// sigma = g degraded_stress + kept_stress and the stored energy is g degraded_energy + kept_energy, J/m^3. All are laws of the plane; those
// for isotropic materials take lambda and mu (Pa), in plane stress the lambda' of law::plane_stress.
#pragma once

#include <cmath>

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

template <class Real>
FRACFARM_POINTWISE Real positive(Real a) {
  return a > Real(0) ? a : Real(0);
}

template <class Real>
FRACFARM_POINTWISE Real negative(Real a) {
  return a < Real(0) ? a : Real(0);
}

// The seed's: normal strains clipped at zero drive, shear whole; the whole stress is degraded (seed paper, eqs 5-7 and 9). Not invariant
// under rotation, and closed cracks overlap.
template <class Real>
struct SeedSplit {
  Stiffness<Real> C;
  static constexpr bool keeps = false;

  // Phi+ = 1/2 [C11 <e_xx>^2 + 2 C13 <e_xx><e_zz> + C33 <e_zz>^2 + C55 gamma^2].
  FRACFARM_POINTWISE Real drive(const Strain<Real>& e) const {
    return strain_energy(C, Strain<Real>{positive(e.xx), positive(e.zz), e.xz});
  }
  FRACFARM_POINTWISE Real degraded_energy(const Strain<Real>& e) const { return strain_energy(C, e); }
  FRACFARM_POINTWISE Real kept_energy(const Strain<Real>&) const { return Real(0); }
  FRACFARM_POINTWISE Stress<Real> degraded_stress(const Strain<Real>& e) const { return stress(C, e); }
  FRACFARM_POINTWISE Stress<Real> kept_stress(const Strain<Real>&) const { return {Real(0), Real(0), Real(0)}; }
};

// None: the whole energy drives and is degraded (Bourdin, Francfort and Marigo, 2000). Cracks form in compression, too.
template <class Real>
struct NoSplit {
  Stiffness<Real> C;
  static constexpr bool keeps = false;

  FRACFARM_POINTWISE Real drive(const Strain<Real>& e) const { return strain_energy(C, e); }
  FRACFARM_POINTWISE Real degraded_energy(const Strain<Real>& e) const { return strain_energy(C, e); }
  FRACFARM_POINTWISE Real kept_energy(const Strain<Real>&) const { return Real(0); }
  FRACFARM_POINTWISE Stress<Real> degraded_stress(const Strain<Real>& e) const { return stress(C, e); }
  FRACFARM_POINTWISE Stress<Real> kept_stress(const Strain<Real>&) const { return {Real(0), Real(0), Real(0)}; }
};

// Spectral: lambda/2 <tr e>^2 + mu sum <e_i>^2 of the positive principal strains (Miehe, Hofacker and Welschinger, 2010).
template <class Real>
struct SpectralSplit {
  Real lambda, mu;
  static constexpr bool keeps = true;

  struct Principal {
    Real mean, radius;  // principal strains are mean + radius and mean - radius
  };
  FRACFARM_POINTWISE Principal principal(const Strain<Real>& e) const {
    const Real half = Real(0.5) * (e.xx - e.zz), shear = Real(0.5) * e.xz;
    return {Real(0.5) * (e.xx + e.zz), std::sqrt(half * half + shear * shear)};
  }
  FRACFARM_POINTWISE Real energy(Real trace, Real first, Real second) const {
    return Real(0.5) * lambda * trace * trace + mu * (first * first + second * second);
  }
  FRACFARM_POINTWISE Stress<Real> part(const Strain<Real>& e, Real radius, Real trace, Real first, Real second) const {
    const Real pressure = lambda * trace + mu * (first + second);
    const Real turn = radius > Real(0) ? mu * (first - second) / radius : Real(0);
    return {pressure + turn * Real(0.5) * (e.xx - e.zz), pressure - turn * Real(0.5) * (e.xx - e.zz), turn * Real(0.5) * e.xz};
  }

  FRACFARM_POINTWISE Real drive(const Strain<Real>& e) const { return degraded_energy(e); }
  FRACFARM_POINTWISE Real degraded_energy(const Strain<Real>& e) const {
    const Principal p = principal(e);
    return energy(positive(e.xx + e.zz), positive(p.mean + p.radius), positive(p.mean - p.radius));
  }
  FRACFARM_POINTWISE Real kept_energy(const Strain<Real>& e) const {
    const Principal p = principal(e);
    return energy(negative(e.xx + e.zz), negative(p.mean + p.radius), negative(p.mean - p.radius));
  }
  FRACFARM_POINTWISE Stress<Real> degraded_stress(const Strain<Real>& e) const {
    const Principal p = principal(e);
    return part(e, p.radius, positive(e.xx + e.zz), positive(p.mean + p.radius), positive(p.mean - p.radius));
  }
  FRACFARM_POINTWISE Stress<Real> kept_stress(const Strain<Real>& e) const {
    const Principal p = principal(e);
    return part(e, p.radius, negative(e.xx + e.zz), negative(p.mean + p.radius), negative(p.mean - p.radius));
  }
};

// Star-convex: mu dev:dev + K/2 (<tr>+^2 - gamma* <tr>-^2) drives, (1 + gamma*) K/2 <tr>-^2 is kept (Vicentini, Zolesi, Carrara, Maurini
// and De Lorenzis, 2024). gamma* = 0 is the volumetric-deviatoric split (Amor, Marigo and Maurini, 2009), -1 is none. `per_dimensions` is
// 1/3 in plane strain, where the deviator is three-dimensional, and 1/2 in plane stress; K = lambda + 2 mu per_dimensions.
template <class Real>
struct StarConvexSplit {
  Real bulk, mu, per_dimensions, gamma;
  static constexpr bool keeps = true;

  FRACFARM_POINTWISE Real deviatoric_energy(const Strain<Real>& e) const {
    const Real trace = e.xx + e.zz;
    return mu * (e.xx * e.xx + e.zz * e.zz + Real(0.5) * e.xz * e.xz - per_dimensions * trace * trace);
  }

  FRACFARM_POINTWISE Real drive(const Strain<Real>& e) const { return positive(degraded_energy(e)); }
  FRACFARM_POINTWISE Real degraded_energy(const Strain<Real>& e) const {
    const Real opening = positive(e.xx + e.zz), closing = negative(e.xx + e.zz);
    return deviatoric_energy(e) + Real(0.5) * bulk * (opening * opening - gamma * closing * closing);
  }
  FRACFARM_POINTWISE Real kept_energy(const Strain<Real>& e) const {
    const Real closing = negative(e.xx + e.zz);
    return (Real(1) + gamma) * Real(0.5) * bulk * closing * closing;
  }
  FRACFARM_POINTWISE Stress<Real> degraded_stress(const Strain<Real>& e) const {
    const Real trace = e.xx + e.zz;
    const Real pressure = bulk * (positive(trace) - gamma * negative(trace)) - Real(2) * mu * per_dimensions * trace;
    return {pressure + Real(2) * mu * e.xx, pressure + Real(2) * mu * e.zz, mu * e.xz};
  }
  FRACFARM_POINTWISE Stress<Real> kept_stress(const Strain<Real>& e) const {
    const Real pressure = (Real(1) + gamma) * bulk * negative(e.xx + e.zz);
    return {pressure, pressure, Real(0)};
  }
};

}  // namespace fracfarm::law
