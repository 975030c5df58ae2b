#include "solver/phasefield/step.hpp"

#include <utility>

#include "solver/phasefield/passes.hpp"

namespace fracfarm::phasefield {
namespace {

template <class Real>
Field<Real>& along(Axis axis, Field<Real>& x, Field<Real>& z) {
  return axis == Axis::x ? x : z;
}

// Velocities of held nodes for the half step around `time`; returns the kinetic energy that the boundary gave them, J/m. No force moves a
// held node: it keeps what it was given until that changes.
template <class Real>
double drive(const Model& model, State<Real>& state, Scratch<Real>& scratch, double time) {
  double gained = 0.0;
  for (std::size_t k = 0; k < model.boundary.motions.size(); ++k) {
    const Motion& motion = model.boundary.motions[k];
    const Real velocity = static_cast<Real>(motion.at(time));
    if (std::exchange(scratch.held_velocity[k], velocity) == velocity) continue;
    Field<Real>& v = along(motion.axis, state.vx, state.vz);
    for (const std::size_t n : motion.nodes) {
      const double now = velocity, before = v[n];
      gained += 0.5 * model.mass[n] * (now * now - before * before);
      v[n] = velocity;
    }
  }
  return gained;
}

template <class Real>
double held_force(const Motion& motion, const Scratch<Real>& scratch) {
  const Field<Real>& f = motion.axis == Axis::x ? scratch.fx : scratch.fz;
  double sum = 0.0;
  for (const std::size_t n : motion.nodes) sum += static_cast<double>(f[n]);
  return sum;
}

template <class Real>
void remember_held_forces(const Model& model, Scratch<Real>& scratch) {
  for (std::size_t k = 0; k < model.boundary.motions.size(); ++k) scratch.held_force[k] = held_force(model.boundary.motions[k], scratch);
}

// Work of the boundary on held nodes over the step that moved them, by the trapezoidal rule. J/m.
template <class Real>
double work_of_motions(const Model& model, Scratch<Real>& scratch, double dt) {
  double work = 0.0;
  for (std::size_t k = 0; k < model.boundary.motions.size(); ++k) {
    const double now = held_force(model.boundary.motions[k], scratch), before = std::exchange(scratch.held_force[k], now);
    work -= 0.5 * (before + now) * dt * static_cast<double>(scratch.held_velocity[k]);
  }
  return work;
}

// Of the step that moved the nodes with the velocities as they are. J/m.
template <class Real>
double work_of_tractions(const Model& model, const State<Real>& state, double before, double after, double dt) {
  double work = 0.0;
  for (const Traction& traction : model.boundary.tractions) {
    const double share = 0.5 * (traction.share(before) + traction.share(after));
    for (std::size_t k = 0; k < traction.nodes.size(); ++k)
      work += share * dt *
              (traction.fx[k] * static_cast<double>(state.vx[traction.nodes[k]]) +
               traction.fz[k] * static_cast<double>(state.vz[traction.nodes[k]]));
  }
  return work;
}

// The tractions of a time, where kick() finds them.
template <class Real>
void pull(const Model& model, Scratch<Real>& scratch, double time) {
  Tables<Real>& tables = scratch.tables;
  for (NodeForce<Real>& force : tables.node_forces) force.x = force.z = Real(0);
  for (const Traction& traction : model.boundary.tractions) {
    const double share = traction.share(time);
    for (std::size_t k = 0; k < traction.nodes.size(); ++k) {
      NodeForce<Real>& force = node_force(model.grid, tables, traction.nodes[k]);
      force.x += static_cast<Real>(share * traction.fx[k]);
      force.z += static_cast<Real>(share * traction.fz[k]);
    }
  }
}

template <class Real>
void set_initial_fields(const Model& model, const Initial& initial, State<Real>& state) {
  const Grid& grid = model.grid;
  const auto& [xx, zz, xz] = initial.strain;
  const auto& L = initial.velocity_gradient;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i) {
      const double x = (i - 0.5 * grid.cells_x()) * grid.hx, z = (j - 0.5 * grid.cells_z()) * grid.hz;
      const std::size_t n = grid.index(i, j);
      state.ux[n] = static_cast<Real>(xx * x + xz * z), state.uz[n] = static_cast<Real>(xz * x + zz * z);
      state.vx[n] = static_cast<Real>(L[0] * x + L[1] * z), state.vz[n] = static_cast<Real>(L[2] * x + L[3] * z);
    }
}

}  // namespace

template <class Real>
Result<void> start(const Model& model, const Initial& initial, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels,
                   double dt) {
  set_initial_fields(model, initial, state);
  strain(model, state, scratch, kernels);
  if (auto solved = solve_damage(model, state, scratch, kernels); !solved) return solved;
  state.psi_previous = state.psi;
  pull(model, scratch, 0.0);
  state.sums = respond(model, state, scratch, kernels, 0.0);
  const SurfaceSum at_start = surface(model, state, scratch, kernels);
  state.initial_energy = state.sums.kinetic + state.sums.elastic;
  state.initial_surface = at_start.local + at_start.gradient;
  state.external_work = drive(model, state, scratch, 0.0);
  state.sums.kinetic += state.external_work;
  respond(model, state, scratch, kernels, 0.5 * dt);
  remember_held_forces(model, scratch);
  return {};
}

template <class Real>
Result<void> step(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n, double dt) {
  const double now = static_cast<double>(n) * dt, next = static_cast<double>(n + 1) * dt;
  StageClock<Stage, stage_names.size()>& clock = scratch.clock;
  clock.begin();
  state.external_work += drive(model, state, scratch, now + 0.5 * dt) + work_of_tractions(model, state, now, next, dt);
  clock.end(Stage::drive);
  if (auto damaged = move_and_damage(model, state, scratch, kernels, n, dt); !damaged) return damaged;
  clock.end(Stage::damage);
  pull(model, scratch, next);
  state.sums = respond(model, state, scratch, kernels, dt);
  clock.end(Stage::force);
  state.released += scratch.released;
  state.external_work += work_of_motions(model, scratch, dt);
  clock.end(Stage::ledger);
  return {};
}

template <class Real>
void refresh(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n, double dt) {
  find_moving(model.grid, state, scratch);
  scratch.psi_other = state.psi;  // of tiles that rest
  set_equation(model, state, scratch, kernels);
  scratch.last_whole = ++scratch.solves;
  pull(model, scratch, static_cast<double>(n) * dt);
  const bool whole = std::exchange(state.whole, true);  // g of all nodes
  respond(model, state, scratch, kernels, 0.0);
  remember_held_forces(model, scratch);
  state.whole = whole;
}

#define FRACFARM_INSTANTIATE(Real)                                                                                       \
  template Result<void> start(const Model&, const Initial&, State<Real>&, Scratch<Real>&, const Kernels<Real>&, double); \
  template Result<void> step(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&, long long, double);       \
  template void refresh(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&, long long, double);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::phasefield
