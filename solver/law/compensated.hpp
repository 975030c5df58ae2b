// What triangles between springy joints are given, so that both together are as stiff, and damp as much, as wanted.
#pragma once

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

// C' = (C^-1 - s I)^-1 on tensors: the compliance of joints of penalty p, rho_L metres of them on a square metre in all directions alike,
// is rho_L / (2 p) (1/Pa); s is what is to be made up for. Right as long as s is below the smallest compliance.
inline Stiffness<double> compensated(const Stiffness<double>& C, double s) {
  const double determinant = C.C11 * C.C33 - C.C13 * C.C13;
  const double S11 = C.C33 / determinant - s, S33 = C.C11 / determinant - s, S13 = -C.C13 / determinant;
  const double inverse = S11 * S33 - S13 * S13;
  return {S33 / inverse, -S13 / inverse, S11 / inverse, 1.0 / (1.0 / C.C55 - 2.0 * s)};
}

// Viscosity in the compensated triangles over that in triangles of C, so that both dissipate as much: at the same stress these are strained
// by B = C^-1 C' times as much, and tr(B^T B) / 3 is the mean of the squares over all directions of strain, as tensors.
inline double damping_ratio(const Stiffness<double>& C, const Stiffness<double>& stiffer) {
  const double determinant = C.C11 * C.C33 - C.C13 * C.C13, S11 = C.C33 / determinant, S33 = C.C11 / determinant,
               S13 = -C.C13 / determinant;
  const double xx = S11 * stiffer.C11 + S13 * stiffer.C13, xz = S11 * stiffer.C13 + S13 * stiffer.C33;
  const double zx = S13 * stiffer.C11 + S33 * stiffer.C13, zz = S13 * stiffer.C13 + S33 * stiffer.C33, shear = stiffer.C55 / C.C55;
  return (xx * xx + xz * xz + zx * zx + zz * zz + shear * shear) / 3.0;
}

}  // namespace fracfarm::law
