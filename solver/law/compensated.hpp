// Stiffness of triangles between springy joints, so that both together are as stiff as the material.
#pragma once

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

// C' = (C^-1 - s I)^-1 on tensors: the compliance of joints of penalty p, rho_L metres of them on a square metre in all directions alike,
// is s = rho_L / (2 p) (1/Pa). Right as long as s is below the smallest compliance.
inline Stiffness<double> compensated(const Stiffness<double>& C, double s) {
  const double determinant = C.C11 * C.C33 - C.C13 * C.C13;
  const double S11 = C.C33 / determinant - s, S33 = C.C11 / determinant - s, S13 = -C.C13 / determinant;
  const double inverse = S11 * S33 - S13 * S13;
  return {S33 / inverse, -S13 / inverse, S11 / inverse, 1.0 / (1.0 / C.C55 - 2.0 * s)};
}

}  // namespace fracfarm::law
