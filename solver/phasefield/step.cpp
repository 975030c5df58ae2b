#include "solver/phasefield/step.hpp"

#include <utility>

#include "solver/phasefield/damage_solve.hpp"

namespace fracfarm::phasefield {
namespace {

Field& along(Axis axis, Field& x, Field& z) { return axis == Axis::x ? x : z; }

// Velocities of held nodes for the half step around `time`; returns the kinetic energy that the boundary gave them, J/m.
double drive(const Model& model, State& state, double time) {
  double gained = 0.0;
  for (const Motion& motion : model.boundary.motions) {
    const double velocity = motion.at(time);
    Field& v = along(motion.axis, state.vx, state.vz);
    for (const std::size_t n : motion.nodes) {
      gained += 0.5 * model.mass[n] * (velocity * velocity - v[n] * v[n]);
      v[n] = velocity;
    }
  }
  return gained;
}

void remember_held_forces(const Model& model, Scratch& scratch) {
  std::size_t k = 0;
  for (const Motion& motion : model.boundary.motions)
    for (const std::size_t n : motion.nodes) scratch.held_force[k++] = along(motion.axis, scratch.fx, scratch.fz)[n];
}

// Work of the boundary on held nodes over the step that moved them, by the trapezoidal rule. J/m.
double work_of_motions(const Model& model, State& state, Scratch& scratch, double dt) {
  double work = 0.0;
  std::size_t k = 0;
  for (const Motion& motion : model.boundary.motions) {
    const Field &f = along(motion.axis, scratch.fx, scratch.fz), &v = along(motion.axis, state.vx, state.vz);
    for (const std::size_t n : motion.nodes) work -= 0.5 * (scratch.held_force[k++] + f[n]) * dt * v[n];
  }
  return work;
}

double work_of_tractions(const Model& model, const State& state, double before, double after, double dt) {
  double work = 0.0;
  for (const Traction& traction : model.boundary.tractions) {
    const double share = 0.5 * (traction.share(before) + traction.share(after));
    for (std::size_t k = 0; k < traction.nodes.size(); ++k)
      work += share * dt * (traction.fx[k] * state.vx[traction.nodes[k]] + traction.fz[k] * state.vz[traction.nodes[k]]);
  }
  return work;
}

void compute_force(const Model& model, State& state, Scratch& scratch, const Kernels& kernels, double time) {
  scratch.stress = kernels.internal_force(view(model, state, scratch));
  for (const Traction& traction : model.boundary.tractions) {
    const double share = traction.share(time);
    for (std::size_t k = 0; k < traction.nodes.size(); ++k) {
      scratch.fx[traction.nodes[k]] += share * traction.fx[k];
      scratch.fz[traction.nodes[k]] += share * traction.fz[k];
    }
  }
}

void set_initial_fields(const Model& model, const Initial& initial, State& state) {
  const Grid& grid = model.grid;
  const auto& [xx, zz, xz] = initial.strain;
  const auto& L = initial.velocity_gradient;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i) {
      const double x = (i - 0.5 * grid.cells_x()) * grid.hx, z = (j - 0.5 * grid.cells_z()) * grid.hz;
      const std::size_t n = grid.index(i, j);
      state.ux[n] = xx * x + xz * z, state.uz[n] = xz * x + zz * z;
      state.vx[n] = L[0] * x + L[1] * z, state.vz[n] = L[2] * x + L[3] * z;
    }
}

// Velocities from t = 0 to t = -dt/2, so that every later step is the same whole kick.
void back_half_a_step(const Model& model, State& state, const Scratch& scratch, double dt) {
  for (std::size_t n = 0; n < state.vx.size(); ++n) {
    state.vx[n] -= 0.5 * dt * (scratch.fx[n] * model.inverse_mass_x[n]);
    state.vz[n] -= 0.5 * dt * (scratch.fz[n] * model.inverse_mass_z[n]);
  }
}

}  // namespace

Result<void> start(const Model& model, const Initial& initial, State& state, Scratch& scratch, const Kernels& kernels, double dt) {
  set_initial_fields(model, initial, state);
  kernels.update_history(view(model, state, scratch));
  if (auto solved = solve_damage(model, state, scratch, kernels); !solved) return solved;
  state.psi_previous = state.psi;
  const View v = view(model, state, scratch);
  scratch.drop = kernels.degrade(v, state.psi.data() + model.grid.origin());
  const SurfaceSum surface = kernels.surface(v, state.psi.data() + model.grid.origin());
  compute_force(model, state, scratch, kernels, 0.0);
  state.initial_energy = kernels.kinetic(v, 0.0) + scratch.drop.elastic;
  state.initial_surface = surface.local + surface.gradient;
  state.external_work = drive(model, state, 0.0);
  back_half_a_step(model, state, scratch, dt);
  return {};
}

Result<void> step(const Model& model, State& state, Scratch& scratch, const Kernels& kernels, long long n, double dt) {
  const double now = static_cast<double>(n) * dt, next = static_cast<double>(n + 1) * dt;
  StageClock<Stage, stage_names.size()>& clock = scratch.clock;
  clock.begin();
  remember_held_forces(model, scratch);
  state.external_work += drive(model, state, now + 0.5 * dt);
  kernels.move(view(model, state, scratch), dt);
  clock.end(Stage::move);
  std::swap(scratch.stored, scratch.stored_before);
  kernels.update_history(view(model, state, scratch));
  clock.end(Stage::history);
  if (auto solved = solve_damage(model, state, scratch, kernels); !solved) return solved;
  clock.end(Stage::damage);
  scratch.drop = kernels.degrade(view(model, state, scratch), state.psi.data() + model.grid.origin());
  clock.end(Stage::degrade);
  compute_force(model, state, scratch, kernels, next);
  clock.end(Stage::force);
  state.released += scratch.drop.released;
  state.external_work += work_of_motions(model, state, scratch, dt) + work_of_tractions(model, state, now, next, dt);
  clock.end(Stage::ledger);
  return {};
}

void refresh(const Model& model, State& state, Scratch& scratch, const Kernels& kernels, long long n, double dt) {
  const View v = view(model, state, scratch);
  kernels.update_history(v);
  scratch.drop = kernels.degrade(v, state.psi.data() + model.grid.origin());
  compute_force(model, state, scratch, kernels, static_cast<double>(n) * dt);
}

}  // namespace fracfarm::phasefield
