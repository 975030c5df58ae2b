#include "solver/phasefield/damage_solve.hpp"

#include <fmt/format.h>

#include <utility>

namespace fracfarm::phasefield {
namespace {

// A held node's row becomes "psi = 1": with these two its Jacobi image is 1 to the last bit, whatever its neighbours are.
constexpr double held_source = 0x1p200;
constexpr double held_inverse = 0x1p-200;

void hold_slots(const Model& model, Scratch& scratch) {
  for (const std::size_t n : model.pinned) scratch.source[n] = held_source, scratch.inverse_diagonal[n] = held_inverse;
}

// Weights of the Chebyshev semi-iteration for a spectrum in [-radius, radius] (Golub and Varga, 1961).
class ChebyshevWeight {
 public:
  explicit ChebyshevWeight(double radius) : square_(radius * radius) {}
  double next() {
    const double given = weight_;
    weight_ = first_ ? 1.0 / (1.0 - 0.5 * square_) : 1.0 / (1.0 - 0.25 * square_ * weight_);
    first_ = false;
    return given;
  }

 private:
  double square_;
  double weight_ = 1.0;
  bool first_ = true;
};

}  // namespace

Result<void> solve_damage(const Model& model, State& state, Scratch& scratch, const Kernels& kernels) {
  const View v = view(model, state, scratch);
  const std::size_t at = model.grid.origin();
  kernels.set_diagonal(v);
  hold_slots(model, scratch);
  kernels.extrapolate(v, state.psi.data() + at, state.psi_previous.data() + at, scratch.psi_other.data() + at);
  ChebyshevWeight weight(model.jacobi_radius);
  Field *psi = &state.psi_previous, *other = &scratch.psi_other;
  for (int sweep = 0; sweep < damage_sweeps_limit; ++sweep) {
    ++state.sweeps;
    const double change = kernels.sweep(v, psi->data() + at, other->data() + at, weight.next());
    if (change <= model.damage_tolerance) {  // of `psi`, which is therefore the field to keep; `other` went one sweep on
      if (psi == &scratch.psi_other) std::swap(state.psi_previous, scratch.psi_other);
      std::swap(state.psi, state.psi_previous);
      return {};
    }
    std::swap(psi, other);
  }
  return fail(Fault::solver_numeric, fmt::format("the phase-field equation did not converge: {} sweeps, limit of the correction {:.1e}",
                                                 damage_sweeps_limit, model.damage_tolerance));
}

}  // namespace fracfarm::phasefield
