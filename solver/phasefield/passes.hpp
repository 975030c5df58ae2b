// Which row when: the passes over the grid that make up a step. A pass goes through the rows once and does on each all that its neighbours
// allow, so that a row is worked on while it is in the cache; the numbers are those of one loop after the other.
#pragma once

#include "common/base/result.hpp"
#include "solver/phasefield/state.hpp"

namespace fracfarm::phasefield {

inline constexpr int damage_sweeps_limit = 1000;

// Where nothing much happens less is done: once psi may rise, three of four steps are light, and only the fourth is whole. A light step
// works on H, psi and g of those tiles (`lanes` neighbouring nodes of a row) alone whose psi moved by more than the model's moved_damage in
// four steps; the others rest: they keep theirs. All nodes move and feel forces in every step, those of tiles that yield, or nearly did in
// the last whole step, by the secant law of the strain as it is.

// The step from n to n + 1: u += dt v, H from u, and psi from H: as many matrix-free Chebyshev-Jacobi sweeps from the extrapolated psi as
// the step before took, then more sweeps of those rows alone whose correction |z - psi|, with z the Jacobi image of psi, is above the
// model's tolerance, and of their neighbours. The corner-quadrature operator is an M-matrix, so that 0 <= psi <= 1 holds for its solution;
// what the sweeps leave beyond is cut. Replaces psi and moves the old field to psi_previous. Errors: SOLVER_NUMERIC past the sweeps limit.
template <class Real>
Result<void> move_and_damage(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n,
                             double dt);

// The psi equation of H as it is: after a restart.
template <class Real>
void set_equation(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels);

// H, energies and the psi equation of u as it is: a start.
template <class Real>
void strain(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels);

// psi of the equation as it is; as in move_and_damage.
template <class Real>
Result<void> solve_damage(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels);

// Degradation, forces with the new psi, v += dt f / m; returns the sums, and leaves scratch.released.
template <class Real>
StepSums respond(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, double dt);

// Energy stored at u with the g of the last step, without what a split keeps. J/m.
template <class Real>
double elastic_energy(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels);

// Surface functional of psi.
template <class Real>
SurfaceSum surface(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels);

}  // namespace fracfarm::phasefield
