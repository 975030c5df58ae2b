#include "solver/phasefield/assembled/step.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "solver/phasefield/assembled/anderson.hpp"
#include "solver/phasefield/assembled/points.hpp"
#include "solver/phasefield/assembled/solvers.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

// Residuals over the elements' own forces. While nothing damages they are rounding: Newmark's energy balance is exact, the factor fits.
// Else a pass only has to be finer than what the damage changes.
constexpr double exact = 1e-15, newmark_tolerance = 1e-10, quasi_static_tolerance = 1e-8;
constexpr double at_rest = 1e-9;     // a step that moves psi by less leaves the factor as good as new
constexpr double unbalanced = 1e-4;  // of the elements' own forces
constexpr double reduction = 3e-2;   // of the residual, in the later passes of a step

double tolerance_after(const State& state, double while_damaging) {
  return (state.psi - state.psi_previous).cwiseAbs().maxCoeff() > at_rest ? while_damaging : exact;
}

Eigen::Index displacement_of(const Motion& motion, std::size_t node) {
  return static_cast<Eigen::Index>(2 * node + (motion.axis == Axis::z));
}

void set_initial_fields(const Model& model, const Initial& initial, State& state) {
  const Grid& grid = model.grid;
  const auto& [xx, zz, xz] = initial.strain;
  const auto& L = initial.velocity_gradient;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i) {
      const double x = (i - 0.5 * grid.cells_x()) * grid.hx, z = (j - 0.5 * grid.cells_z()) * grid.hz;
      const int n = 2 * model.node(i, j);
      state.u[n] = xx * x + xz * z, state.u[n + 1] = xz * x + zz * z;
      state.v[n] = L[0] * x + L[1] * z, state.v[n + 1] = L[2] * x + L[3] * z;
    }
}

// Velocities of held nodes; returns the kinetic energy that the boundary gave them, J/m.
double drive(const Model& model, State& state, double time) {
  double gained = 0.0;
  for (const Motion& motion : model.boundary.motions) {
    const double velocity = motion.at(time);
    for (const std::size_t n : motion.nodes) {
      const Eigen::Index d = displacement_of(motion, n);
      gained += 0.5 * model.mass[d] * (velocity * velocity - state.v[d] * state.v[d]);
      state.v[d] = velocity;
    }
  }
  return gained;
}

// Work of told displacements by the trapezoidal rule, and of tractions. J/m.
double work_of_loads(const Model& model, const State& state, const Scratch& scratch, double before, double after) {
  const Vector moved = state.u - scratch.u_before;
  double work = 0.0;
  for (std::size_t d = 0; d < model.equation.size(); ++d) {
    const auto at = static_cast<Eigen::Index>(d);
    if (model.equation[d] < 0) work -= 0.5 * (scratch.force_before[at] + scratch.force[at]) * moved[at];
  }
  for (const Traction& traction : model.boundary.tractions) {
    const double share = 0.5 * (traction.share(before) + traction.share(after));
    for (std::size_t k = 0; k < traction.nodes.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(2 * traction.nodes[k]);
      work += share * (traction.fx[k] * moved[at] + traction.fz[k] * moved[at + 1]);
    }
  }
  return work;
}

void begin_step(State& state, Scratch& scratch) {
  scratch.clock.begin();
  std::swap(scratch.now, scratch.before);
  scratch.g_before = scratch.g;
  scratch.force_before = scratch.force;
  scratch.u_before = state.u;
}

// Forces with the new damage, ledger, and what the next step remembers.
void end_step(const Model& model, State& state, Scratch& scratch, double before, double after) {
  compute_force(model, after, scratch);
  scratch.clock.end(Stage::force);
  state.largest_force = std::max(state.largest_force, scratch.force_scale);
  const StepEnergies energies = energies_of_step(model, state, scratch);
  state.released += energies.released;
  state.plastic_work += energies.plastic;
  state.external_work += work_of_loads(model, state, scratch, before, after);
  state.history = scratch.history;
  for (std::size_t p = 0; p < state.plastic.size(); ++p) state.plastic[p] = scratch.now[p].plastic;
  scratch.clock.end(Stage::ledger);
}

Result<void> explicit_step(const Model& model, State& state, Scratch& scratch, double now, double dt) {
  state.external_work += drive(model, state, now + 0.5 * dt);
  for (std::size_t d = 0; d < model.equation.size(); ++d) {
    const auto at = static_cast<Eigen::Index>(d);
    if (model.equation[d] >= 0) state.v[at] += dt * (scratch.force[at] / model.mass[at]);
    state.u[at] += dt * state.v[at];
  }
  scratch.clock.end(Stage::move);
  respond(model, state, state.u, Flow::on, scratch);
  update_history(model, state, scratch);
  scratch.clock.end(Stage::history);
  const Vector guess = 2.0 * state.psi - state.psi_previous;
  state.psi_previous = state.psi;
  if (auto solved = solve_damage(model, guess, state.psi_previous, state, scratch); !solved) return solved;
  scratch.clock.end(Stage::damage);
  degrade(model, state, scratch);
  scratch.clock.end(Stage::degrade);
  return {};
}

// Displacement and damage in turns until psi settles. An increment that did not settle in the passes that it has goes on in the next one.
Result<void> staggered_passes(const Model& model, Balance balance, State& state, Scratch& scratch) {
  state.psi_previous = state.psi;
  Anderson anderson;
  for (int pass = 0; pass < model.settings.staggered_passes; ++pass) {
    balance.reduction = pass > 0 ? reduction : 0.0;
    ++state.passes;
    if (auto solved = solve_displacement(model, balance, state, scratch); !solved) return solved;
    scratch.clock.end(Stage::move);
    update_history(model, state, scratch);
    scratch.clock.end(Stage::history);
    const Vector psi = state.psi;
    if (auto solved = solve_damage(model, psi, state.psi_previous, state, scratch); !solved) return solved;
    scratch.clock.end(Stage::damage);
    degrade(model, state, scratch);
    scratch.clock.end(Stage::degrade);
    if ((state.psi - psi).cwiseAbs().maxCoeff() < model.settings.staggered_tolerance || pass + 1 == model.settings.staggered_passes) break;
    state.psi = anderson.next(psi, state.psi).cwiseMax(state.psi_previous).cwiseMin(1.0);
    degrade(model, state, scratch);
  }
  return {};
}

// u = u* + beta dt^2 a, v = v + dt ((1 - gamma) a_n + gamma a), u* = u + dt v + dt^2 (1/2 - beta) a_n (Newmark, 1959).
Result<void> newmark_step(const Model& model, State& state, Scratch& scratch, double now, double dt) {
  const double beta = model.settings.newmark_beta, gamma = model.settings.newmark_gamma;
  const Vector v = state.v, predictor = state.u + dt * state.v + dt * dt * (0.5 - beta) * state.a;
  state.external_work += drive(model, state, now + dt);
  for (std::size_t d = 0; d < model.equation.size(); ++d) {
    const auto at = static_cast<Eigen::Index>(d);
    state.u[at] = model.equation[d] >= 0 ? predictor[at] + beta * dt * dt * state.a[at] : state.u[at] + 0.5 * dt * (v[at] + state.v[at]);
  }
  const Balance balance{now + dt, 1.0 / (beta * dt * dt), &predictor, tolerance_after(state, newmark_tolerance)};
  if (auto solved = staggered_passes(model, balance, state, scratch); !solved) return solved;
  for (std::size_t d = 0; d < model.equation.size(); ++d) {
    if (model.equation[d] < 0) continue;
    const auto at = static_cast<Eigen::Index>(d);
    const double a = (state.u[at] - predictor[at]) * balance.inertia;
    state.v[at] = v[at] + dt * ((1.0 - gamma) * state.a[at] + gamma * a);
    state.a[at] = a;
  }
  return {};
}

// A corner that only keeps the body from drifting carries nothing, unless the tractions push the body away.
Result<void> check_supports(const Model& model, const Scratch& scratch) {
  for (const std::size_t d : model.supports) {
    const double force = scratch.force[static_cast<Eigen::Index>(d)];
    if (std::abs(force) > unbalanced * scratch.force_scale)
      return fail(Fault::solver_numeric,
                  fmt::format("the tractions are not in balance and nothing holds the body along {}: {:.4g} N/m are left over",
                              d % 2 ? "z" : "x", force));
  }
  return {};
}

Result<void> quasi_static_step(const Model& model, State& state, Scratch& scratch, double now, double dt) {
  for (const Motion& motion : model.boundary.motions)
    for (const std::size_t n : motion.nodes) state.u[displacement_of(motion, n)] += dt * motion.at(now + 0.5 * dt);
  const Prescription& told = model.prescription;
  for (std::size_t k = 0; k < told.told.size(); ++k)
    state.u[2 * model.node(told.told[k].column, told.told[k].row) + (told.told[k].axis == Axis::z)] = told.displacement(k, now + dt);
  if (auto settled = staggered_passes(model, {now + dt, 0.0, nullptr, tolerance_after(state, quasi_static_tolerance)}, state, scratch);
      !settled)
    return settled;
  return check_supports(model, scratch);
}

Result<void> advance(const Model& model, State& state, Scratch& scratch, double now, double dt) {
  switch (model.settings.integrator) {
    case Integrator::newmark:
      return newmark_step(model, state, scratch, now, dt);
    case Integrator::quasi_static:
      return quasi_static_step(model, state, scratch, now, dt);
    case Integrator::explicit_central:
      break;
  }
  return explicit_step(model, state, scratch, now, dt);
}

double kinetic(const Model& model, const Vector& v) { return 0.5 * model.mass.dot(v.cwiseAbs2()); }

// Explicit: velocities go back half a step, so that every later step is the same whole kick. Newmark: the first acceleration.
void set_velocities(const Model& model, State& state, const Scratch& scratch, double dt) {
  if (model.settings.integrator == Integrator::quasi_static) return state.v.setZero(), void();
  state.external_work = drive(model, state, 0.0);
  for (std::size_t d = 0; d < model.equation.size(); ++d) {
    if (model.equation[d] < 0) continue;
    const auto at = static_cast<Eigen::Index>(d);
    const double a = scratch.force[at] / model.mass[at];
    if (model.settings.integrator == Integrator::newmark)
      state.a[at] = a;
    else
      state.v[at] -= 0.5 * dt * a;
  }
}

}  // namespace

Result<void> start(const Model& model, const Initial& initial, State& state, Scratch& scratch, double dt) {
  set_initial_fields(model, initial, state);
  respond(model, state, state.u, Flow::on, scratch);
  update_history(model, state, scratch);
  state.history = scratch.history;
  if (auto solved = solve_damage(model, state.psi, state.psi, state, scratch); !solved) return solved;
  state.psi_previous = state.psi;
  for (std::size_t p = 0; p < state.plastic.size(); ++p) state.plastic[p] = scratch.now[p].plastic;
  degrade(model, state, scratch);
  compute_force(model, 0.0, scratch);
  state.initial_energy = kinetic(model, state.v) + elastic_energy(model, scratch);
  state.initial_surface = surface(model, state.psi).energy;
  set_velocities(model, state, scratch, dt);
  return {};
}

Result<void> step(const Model& model, State& state, Scratch& scratch, long long n, double dt) {
  const double now = static_cast<double>(n) * dt, next = static_cast<double>(n + 1) * dt;
  begin_step(state, scratch);
  if (auto advanced = advance(model, state, scratch, now, dt); !advanced) return advanced;
  end_step(model, state, scratch, now, next);
  return {};
}

void refresh(const Model& model, const State& state, Scratch& scratch, long long n, double dt) {
  respond(model, state, state.u, Flow::frozen, scratch);
  degrade(model, state, scratch);
  compute_force(model, static_cast<double>(n) * dt, scratch);
}

}  // namespace fracfarm::phasefield::assembled
