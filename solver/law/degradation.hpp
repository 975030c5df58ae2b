// Degradation of the whole stress: g(psi) = (1 - eta)(1 - psi)^2 + eta (seed paper, eq. 9; eta is also its xi).
#pragma once

#include "solver/law/pointwise.hpp"

namespace fracfarm::law {

FRACFARM_POINTWISE double degradation(double psi, double eta) {
  const double intact = 1.0 - psi;
  return (1.0 - eta) * intact * intact + eta;
}

}  // namespace fracfarm::law
