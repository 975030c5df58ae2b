// The crack surface functional per volume, J/m^3: AT2 is G_c (psi^2 / (2 w_0) + w_0 |grad psi|^2 / 2) (Ambrosio and Tortorelli, 1990);
// AT1 is 3/8 G_c (psi / w_0 + w_0 |grad psi|^2) (Pham, Amor, Marigo and Maurini, 2011). Both give the equation
// mass psi - slope lap psi = 2 (1 - psi) H - threshold with the constants below. AT1 has an elastic range: with H floored at `floor` the
// right side is never negative, so 0 <= psi <= 1 holds as it does for AT2.
#pragma once

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

template <class Real>
struct SurfaceLaw {
  Real mass;       // J/m^3, of psi
  Real slope;      // J/m, of -lap psi
  Real threshold;  // J/m^3
  Real floor;      // J/m^3, least H
};

// G_c in J/m^2, w_0 in m.
template <class Real>
FRACFARM_POINTWISE SurfaceLaw<Real> at2(Real Gc, Real width) {
  return {Gc / width, Gc * width, Real(0), Real(0)};
}

template <class Real>
FRACFARM_POINTWISE SurfaceLaw<Real> at1(Real Gc, Real width) {
  return {Real(0), Real(0.75) * Gc * width, Real(0.375) * Gc / width, Real(0.1875) * Gc / width};
}

}  // namespace fracfarm::law
