// The loops over elements: strains to answers, answers to forces, stiffness and energies; the psi equation's matrix and right side.
#pragma once

#include "solver/phasefield/assembled/state.hpp"

namespace fracfarm::phasefield::assembled {

enum class Flow { on, frozen };  // plastic strains grow from state.plastic, or are state.plastic

// Answers at all points to the strain of `u`. Fills scratch.now.
void respond(const Model& model, const State& state, const Vector& u, Flow flow, Scratch& scratch);
// scratch.history = max(state.history, drive).
void update_history(const Model& model, const State& state, Scratch& scratch);
// scratch.g of psi at the points.
void degrade(const Model& model, const State& state, Scratch& scratch);
// scratch.force = -B^T sigma + tractions at `time`, its scale and the stress sum, from answers and g.
void compute_force(const Model& model, double time, Scratch& scratch);
// scratch.stiffness = d(B^T sigma)/du at `u` + `inertia` mass.
void assemble_stiffness(const Model& model, const State& state, const Vector& u, double inertia, Scratch& scratch);
// scratch.damage and scratch.damage_source of the psi equation with scratch.history.
void assemble_damage(const Model& model, Scratch& scratch);

struct StepEnergies {
  double released = 0.0;  // by the change of g over the step at fixed strain, J/m
  double plastic = 0.0;   // degraded plastic work of the step, J/m
};
// Between scratch.before and scratch.now.
StepEnergies energies_of_step(const Model& model, const State& state, const Scratch& scratch);
// Stored and degraded, J/m.
double elastic_energy(const Model& model, const Scratch& scratch);

struct SurfaceSum {
  double energy = 0.0;  // the crack surface functional, J/m
  double length = 0.0;  // twice (AT2) the gradient part over G_c, m
};
SurfaceSum surface(const Model& model, const Vector& psi);

}  // namespace fracfarm::phasefield::assembled
