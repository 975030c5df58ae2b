// Softening curves of a joint: z(D), the share of its strength that a joint of damage D keeps, z(0) = 1, z(1) = 0.
#pragma once

#include "solver/law/branchless.hpp"

namespace fracfarm::law {

// e^x for x in [-4, 0], within 2e-12: Taylor to degree 10 of x / 16, then four squarings. The same operations for every instruction set.
template <class Real>
FRACFARM_POINTWISE Real exp_of_negative(Real x) {
  const Real y = x * Real(1.0 / 16.0);
  Real sum = Real(1.0 / 3628800.0);
  for (const double term : {1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0})
    sum = sum * y + Real(term);
  sum = sum * sum;
  sum = sum * sum;
  sum = sum * sum;
  return sum * sum;
}

// z = [1 - (a+b-1)/(a+b) exp(D (a+cb)/((a+b)(1-a-b)))] [a(1-D) + b(1-D)^c], a = 0.63, b = 1.8, c = 6 (Munjiza, Andrews and White, 1999,
// eq. 7). Its area is 0.38631.
struct Munjiza {
  static constexpr double a = 0.63, b = 1.8, c = 6.0;

  template <class Real>
  FRACFARM_POINTWISE static Real kept(Real D) {
    const Real rest = Real(1) - D, square = rest * rest, sixth = square * square * square;
    const Real fall = exp_of_negative(D * Real((a + c * b) / ((a + b) * (1.0 - a - b))));
    return (Real(1) - Real((a + b - 1.0) / (a + b)) * fall) * (Real(a) * rest + Real(b) * sixth);
  }
};

// z = 1 - D.
struct LinearSoftening {
  template <class Real>
  FRACFARM_POINTWISE static Real kept(Real D) {
    return Real(1) - D;
  }
};

// Area under a curve, by Simpson's rule; 1e-12 on these curves.
template <class Curve>
double area_under() {
  constexpr int parts = 1000;
  double sum = Curve::kept(0.0) + Curve::kept(1.0);
  for (int i = 1; i < parts; ++i) sum += (i % 2 ? 4.0 : 2.0) * Curve::kept(static_cast<double>(i) / parts);
  return sum / (3.0 * parts);
}

}  // namespace fracfarm::law
