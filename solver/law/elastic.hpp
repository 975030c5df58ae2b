// Orthotropic linear elasticity in plane strain, z vertical. Stress positive in tension, Pa; shear strain is gamma_xz = du_x/dz + du_z/dx.
#pragma once

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

struct Strain {
  double xx;
  double zz;
  double xz;  // gamma, twice the tensor's component
};

struct Stress {
  double xx;
  double zz;
  double xz;
};

struct Stiffness {
  double C11;
  double C13;
  double C33;
  double C55;
};

// sigma = C epsilon (seed paper, eq. 9 without the degradation).
FRACFARM_POINTWISE Stress stress(const Stiffness& C, const Strain& e) {
  return {C.C11 * e.xx + C.C13 * e.zz, C.C13 * e.xx + C.C33 * e.zz, C.C55 * e.xz};
}

// 1/2 epsilon : C : epsilon, J/m^3, undegraded.
FRACFARM_POINTWISE double strain_energy(const Stiffness& C, const Strain& e) {
  return 0.5 * (C.C11 * e.xx * e.xx + 2.0 * C.C13 * e.xx * e.zz + C.C33 * e.zz * e.zz + C.C55 * e.xz * e.xz);
}

}  // namespace fracfarm::law
