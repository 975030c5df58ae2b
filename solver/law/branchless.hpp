// Words that read the same for one number and for a register of numbers, so that a law written with them serves both: select(condition, a,
// b), larger, smaller. The register's own versions are found by the type of their arguments.
#pragma once

#include <cmath>

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

using std::sqrt;

template <class Real>
FRACFARM_POINTWISE Real select(bool condition, Real a, Real b) {
  return condition ? a : b;
}

template <class Real>
FRACFARM_POINTWISE Real larger(Real a, Real b) {
  return select(a > b, a, b);
}

template <class Real>
FRACFARM_POINTWISE Real smaller(Real a, Real b) {
  return select(a > b, b, a);
}

}  // namespace fracfarm::law
