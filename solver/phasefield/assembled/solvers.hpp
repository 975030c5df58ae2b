// The two equations of a step, each with the other's field held: displacements in balance at fixed damage, damage at fixed history.
#pragma once

#include "solver/phasefield/assembled/state.hpp"

namespace fracfarm::phasefield::assembled {

// force(u) = inertia mass (u - predictor) on the free displacements.
struct Balance {
  double time = 0.0;                  // s
  double inertia = 0.0;               // 1/s^2; 0: static
  const Vector* predictor = nullptr;  // where inertia > 0
  double tolerance = 0.0;             // of the residual over the elements' own forces
  double reduction = 0.0;             // or of the residual over that at the start, where that is enough
};

// Newton's method with a line search from state.u, whose told values stay. Leaves scratch.now and the force at the new state.u.
// Errors: SOLVER_NUMERIC.
Result<void> solve_displacement(const Model& model, const Balance& balance, State& state, Scratch& scratch);

// With scratch.history, from `guess`; psi between `floor` and 1 is imposed where the quadrature does not give it. Errors: SOLVER_NUMERIC.
Result<void> solve_damage(const Model& model, const Vector& guess, const Vector& floor, State& state, Scratch& scratch);

}  // namespace fracfarm::phasefield::assembled
