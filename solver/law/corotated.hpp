// Large rotations, small strains in the plane: F = I + H = R U with R in closed form, and the Biot strain U - I without cancellation
// (tr F and F21 - F12 give the angle), so that it is as exact in float as H is.
#pragma once

#include "solver/law/branchless.hpp"
#include "solver/law/elastic.hpp"

namespace fracfarm::law {

// Displacement gradient: xz = du_x/dZ, zx = du_z/dX.
template <class Real>
struct Gradient {
  Real xx, xz, zx, zz;
};

// R = [[1 + c1, -s], [s, 1 + c1]].
template <class Real>
struct Turn {
  Real c1, c, s;
  Real per_trace;  // 1 / tr U
};

// cos - 1 = -b^2 / (n (n + 2 + a)) with a = H11 + H22, b = H21 - H12, n = tr U; past a quarter turn, where n + 2 + a would cancel and be 0
// at a half turn, -(n - 2 - a) / n.
template <class Real>
FRACFARM_POINTWISE Turn<Real> turn(const Gradient<Real>& H) {
  const Real b = H.zx - H.xz, trace = Real(2) + (H.xx + H.zz);
  const Real n = sqrt(trace * trace + b * b);
  const auto ahead = trace > Real(0);
  const Real both = n + select(ahead, trace, -trace), scale = Real(1) / (n * both);
  const Real per_trace = scale * both, c1 = -(select(ahead, b * b, both * both) * scale);
  return {c1, Real(1) + c1, b * per_trace, per_trace};
}

// U - I; xz is gamma.
template <class Real>
FRACFARM_POINTWISE Strain<Real> biot(const Gradient<Real>& H, const Turn<Real>& R) {
  return {R.c1 + (R.c * H.xx + R.s * H.zx), R.c1 + (R.c * H.zz - R.s * H.xz), R.c * (H.xz + H.zx) + R.s * (H.zz - H.xx)};
}

// Symmetric part of R^T G: the rate of strain in the turned frame where G is a velocity gradient; xz is gamma.
template <class Real>
FRACFARM_POINTWISE Strain<Real> rate(const Gradient<Real>& G, const Turn<Real>& R) {
  return {R.c * G.xx + R.s * G.zx, R.c * G.zz - R.s * G.xz, R.c * (G.xz + G.zx) + R.s * (G.zz - G.xx)};
}

// First Piola-Kirchhoff stress: P = dW/dF = R (S + k J), J = [[0, 1], [-1, 0]], S = dW/dU. k is 0 for isotropic laws; it keeps P F^T
// symmetric, and with it the angular momentum, where S and U have other axes.
template <class Real>
FRACFARM_POINTWISE Gradient<Real> piola(const Stress<Real>& S, const Strain<Real>& E, const Turn<Real>& R) {
  const Real k = ((S.zz - S.xx) * (Real(0.5) * E.xz) + S.xz * (E.xx - E.zz)) * R.per_trace;
  const Real xz = S.xz + k, zx = S.xz - k;
  return {R.c * S.xx - R.s * zx, R.c * xz - R.s * S.zz, R.s * S.xx + R.c * zx, R.s * xz + R.c * S.zz};
}

}  // namespace fracfarm::law
