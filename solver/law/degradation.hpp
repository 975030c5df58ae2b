// Degradation g(psi) = (1 - eta)(1 - psi)^2 + eta (seed paper, eq. 9; eta is also its xi).
#pragma once

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

template <class Real>
FRACFARM_POINTWISE Real degradation(Real psi, Real eta) {
  const Real intact = Real(1) - psi;
  return (Real(1) - eta) * intact * intact + eta;
}

}  // namespace fracfarm::law
