// One time step of the phase-field method: central differences, then history, damage and the force with the new damage.
#pragma once

#include "common/base/result.hpp"
#include "solver/phasefield/state.hpp"

namespace fracfarm::phasefield {

// Displacements (m) and velocities (m/s) at t = 0, relaxed damage around the initial cracks, forces; velocities then go half a step ahead.
template <class Real>
Result<void> start(const Model& model, const Initial& initial, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels,
                   double dt);

// From time n dt to (n + 1) dt: u -> H -> psi -> force with the new psi -> v. Errors: SOLVER_NUMERIC.
template <class Real>
Result<void> step(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n, double dt);

// Scratch from a state that was just loaded, at time n dt.
template <class Real>
void refresh(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n, double dt);

}  // namespace fracfarm::phasefield
