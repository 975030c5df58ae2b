// One step of the assembled path, by integrator: explicit central differences, Newmark, quasi-static.
#pragma once

#include "solver/phasefield/assembled/state.hpp"

namespace fracfarm::phasefield::assembled {

// Displacements and velocities at t = 0, relaxed damage around the initial cracks, forces.
Result<void> start(const Model& model, const Initial& initial, State& state, Scratch& scratch, double dt);

// From time n dt to (n + 1) dt. Errors: SOLVER_NUMERIC.
Result<void> step(const Model& model, State& state, Scratch& scratch, long long n, double dt);

// Scratch from a state that was just loaded, at time n dt.
void refresh(const Model& model, const State& state, Scratch& scratch, long long n, double dt);

}  // namespace fracfarm::phasefield::assembled
