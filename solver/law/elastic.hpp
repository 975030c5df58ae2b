// Orthotropic linear elasticity in the plane, z vertical. Stress positive in tension, Pa; shear strain is gamma_xz = du_x/dz + du_z/dx.
// Laws are templates on the number type: double or float.
#pragma once

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

template <class Real>
struct Strain {
  Real xx;
  Real zz;
  Real xz;  // gamma, twice the tensor's component
};

template <class Real>
struct Stress {
  Real xx;
  Real zz;
  Real xz;
};

template <class Real>
struct Stiffness {
  Real C11;
  Real C13;
  Real C33;
  Real C55;
};

// sigma = C epsilon (seed paper, eq. 9 without the degradation).
template <class Real>
FRACFARM_POINTWISE Stress<Real> stress(const Stiffness<Real>& C, const Strain<Real>& e) {
  return {C.C11 * e.xx + C.C13 * e.zz, C.C13 * e.xx + C.C33 * e.zz, C.C55 * e.xz};
}

// 1/2 epsilon : C : epsilon, J/m^3, undegraded.
template <class Real>
FRACFARM_POINTWISE Real strain_energy(const Stiffness<Real>& C, const Strain<Real>& e) {
  return Real(0.5) * (C.C11 * e.xx * e.xx + Real(2) * C.C13 * e.xx * e.zz + C.C33 * e.zz * e.zz + C.C55 * e.xz * e.xz);
}

// Plane stress of an isotropic material: lambda' = 2 lambda mu / (lambda + 2 mu), from sigma_yy = 0.
template <class Real>
FRACFARM_POINTWISE Stiffness<Real> plane_stress(const Stiffness<Real>& C) {
  const Real lambda = Real(2) * C.C13 * C.C55 / (C.C13 + Real(2) * C.C55);
  return {lambda + Real(2) * C.C55, lambda, lambda + Real(2) * C.C55, C.C55};
}

}  // namespace fracfarm::law
