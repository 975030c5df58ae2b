#include "solver/phasefield/assembled/solvers.hpp"

#include <fmt/format.h>

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

#include "solver/phasefield/assembled/points.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

constexpr int newton_limit = 60;
constexpr int line_search_limit = 8;
constexpr double rounding = 1e-15;
constexpr double flat = 0.7;               // a step is short enough where the residual along it is below this share of its start
constexpr double stalled = 1e-6;           // a residual that no iteration lowers any more is rounding if it is below this
constexpr double remembered_force = 1e-3;  // of the largest force so far: residuals below a broken body's own forces do not matter
constexpr double loose = 1e-3;             // linear systems inside Newton's iterations
constexpr int damage_iterations_limit = 5000;

class NewtonSolve {
 public:
  NewtonSolve(const Model& model, const Balance& balance, State& state, Scratch& scratch)
      : model_(model), balance_(balance), state_(state), scratch_(scratch), residual_(model.equations) {}

  Result<void> go() {
    evaluate(state_.u);
    const double enough = balance_.reduction * residual_.norm();
    double last = INFINITY;
    for (int k = 0; k < newton_limit; ++k) {
      const double size = residual_.norm(), scale = std::max(scratch_.force_scale, remembered_force * state_.largest_force);
      if (!std::isfinite(size)) return fail(Fault::solver_numeric, "the residual of the displacements is not finite");
      const double limit = std::max({balance_.tolerance * scale, enough, rounding * inertia_scale_});
      if (size <= limit || (size > 0.5 * last && size <= stalled * scale)) return {};
      last = size;
      assemble();
      auto direction = scratch_.displacement_solver.solve(scratch_.stiffness.lower(), residual_,
                                                          std::max(0.5 * limit, model_.linear ? 0.0 : loose * size));
      if (!direction) return tl::unexpected(direction.error());
      advance(*direction);
    }
    return fail(Fault::solver_numeric, fmt::format("the displacements did not converge in {} iterations: residual {:.3g} N/m of {:.3g} N/m",
                                                   newton_limit, residual_.norm(), scratch_.force_scale));
  }

 private:
  // Of linear laws the stiffness follows from g and the inertia.
  void assemble() {
    if (model_.linear && scratch_.stiffness_inertia == balance_.inertia && scratch_.stiffness_g == scratch_.g) return;
    assemble_stiffness(model_, state_, state_.u, balance_.inertia, scratch_);
    if (!model_.linear) return;
    scratch_.stiffness_g = scratch_.g;
    scratch_.stiffness_inertia = balance_.inertia;
  }

  void evaluate(const Vector& u) {
    respond(model_, state_, u, Flow::on, scratch_);
    compute_force(model_, balance_.time, scratch_);
    inertia_scale_ = balance_.inertia * model_.mass.cwiseProduct(u).norm();
    for (std::size_t d = 0; d < model_.equation.size(); ++d) {
      if (model_.equation[d] < 0) continue;
      const auto at = static_cast<Eigen::Index>(d);
      residual_[model_.equation[d]] = scratch_.force[at];
      if (balance_.inertia > 0.0) residual_[model_.equation[d]] -= balance_.inertia * model_.mass[at] * (u[at] - (*balance_.predictor)[at]);
    }
  }

  void move(const Vector& from, const Vector& direction, double share) {
    for (std::size_t d = 0; d < model_.equation.size(); ++d)
      if (model_.equation[d] >= 0)
        state_.u[static_cast<Eigen::Index>(d)] = from[static_cast<Eigen::Index>(d)] + share * direction[model_.equation[d]];
    evaluate(state_.u);
  }

  // The potential is convex: its slope along the direction rises from -residual . direction and passes 0 at the best share.
  void advance(const Vector& direction) {
    const Vector from = state_.u;
    const double first = residual_.dot(direction);
    double share = 1.0;
    move(from, direction, share);
    for (int k = 0; k < line_search_limit && !model_.linear; ++k) {
      const double slope = residual_.dot(direction);
      if (!(slope < -flat * first)) return;
      share *= std::clamp(first / (first - slope), 0.1, 0.9);
      move(from, direction, share);
    }
  }

  const Model& model_;
  const Balance& balance_;
  State& state_;
  Scratch& scratch_;
  Vector residual_;             // by equation, N/m
  double inertia_scale_ = 0.0;  // N/m, of the two terms whose difference is the inertia
};

// A x = b in the unknowns sqrt(diagonal) x, so that the tolerance holds where the drive is small beside where it is huge.
class ScaledSystem {
 public:
  ScaledSystem(Eigen::SparseMatrix<double> lower, const Vector& b) : matrix_(std::move(lower)), scale_(matrix_.diagonal().cwiseSqrt()) {
    for (int column = 0; column < matrix_.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix_, column); entry; ++entry)
        entry.valueRef() /= scale_[entry.row()] * scale_[entry.col()];
    b_ = b.cwiseQuotient(scale_);
  }
  template <class Solver>
  Vector solve(Solver& solver, const Vector& guess) const {
    solver.compute(matrix_);
    const Vector scaled = solver.solveWithGuess(b_, guess.cwiseProduct(scale_));
    return scaled.cwiseQuotient(scale_);
  }

 private:
  Eigen::SparseMatrix<double> matrix_;
  Vector scale_, b_;
};

}  // namespace

Result<void> solve_displacement(const Model& model, const Balance& balance, State& state, Scratch& scratch) {
  return NewtonSolve(model, balance, state, scratch).go();
}

Result<void> solve_damage(const Model& model, const Vector& guess, const Vector& floor, State& state, Scratch& scratch) {
  assemble_damage(model, scratch);
  Vector start(model.psi_equations);
  for (std::size_t n = 0; n < model.psi_equation.size(); ++n)
    if (model.psi_equation[n] >= 0) start[model.psi_equation[n]] = guess[static_cast<Eigen::Index>(n)];
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::IdentityPreconditioner> solver;
  solver.setTolerance(model.damage_tolerance);
  solver.setMaxIterations(damage_iterations_limit);
  const Vector psi = ScaledSystem(scratch.damage.lower(), scratch.damage_source).solve(solver, start);
  state.iterations += solver.iterations();
  if (solver.info() != Eigen::Success || !psi.allFinite())
    return fail(Fault::solver_numeric,
                fmt::format("the phase-field equation did not converge: {} iterations, residual {:.1e}, limit {:.1e}", solver.iterations(),
                            solver.error(), model.damage_tolerance));
  // The corner-quadrature operator bounds its solution, and what the iterations leave beyond is cut; Gauss points need the bounds imposed.
  const bool imposed = model.settings.quadrature == Quadrature::gauss;
  for (std::size_t n = 0; n < model.psi_equation.size(); ++n) {
    if (model.psi_equation[n] < 0) continue;
    const auto at = static_cast<Eigen::Index>(n);
    const double value = psi[model.psi_equation[n]];
    state.psi[at] = imposed ? std::clamp(value, std::clamp(floor[at], 0.0, 1.0), 1.0) : std::clamp(value, 0.0, 1.0);
  }
  return {};
}

}  // namespace fracfarm::phasefield::assembled
