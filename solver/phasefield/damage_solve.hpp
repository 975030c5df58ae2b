// The psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H at the nodes, psi = 1 held on the slots: matrix-free Chebyshev-Jacobi sweeps
// from an extrapolated guess, until the largest Jacobi correction is small. The corner-quadrature operator is an M-matrix: 0 <= psi <= 1
// needs no clipping.
#pragma once

#include "common/base/result.hpp"
#include "solver/phasefield/state.hpp"

namespace fracfarm::phasefield {

inline constexpr int damage_sweeps_limit = 1000;

// Needs scratch.source. Replaces state.psi and moves the old field to state.psi_previous. Errors: SOLVER_NUMERIC past the sweeps limit.
Result<void> solve_damage(const Model& model, State& state, Scratch& scratch, const Kernels& kernels);

}  // namespace fracfarm::phasefield
