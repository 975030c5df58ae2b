// The edge of the time step of a body: the largest dt whose undamaged oscillations do not grow, penalty, slivers and viscosity included.
#pragma once

#include "solver/fdem/plan.hpp"

namespace fracfarm::fdem {

// s. With the viscous force taken half a step late, u(n+1) - 2 u(n) + u(n-1) = -dt^2 K u - dt C (u(n) - u(n-1)) per unit mass, the edge is
// where the largest eigenvalue of dt^2 K + 2 dt C reaches 4.
double stable_step(const Plan& plan);

}  // namespace fracfarm::fdem
