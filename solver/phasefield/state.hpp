// State: exactly what a restart needs. Scratch: everything that follows from it, allocated before the loop.
#pragma once

#include <array>
#include <vector>

#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/phasefield/model.hpp"
#include "solver/stage_clock.hpp"

namespace fracfarm::phasefield {

struct State {
  Field ux, uz;                  // m
  Field vx, vz;                  // m/s, half a step before the displacements
  std::array<Field, 4> history;  // H at the corners sw se nw ne of each element, J/m^3
  Field psi, psi_previous;       // of this step and the one before (its extrapolation starts the next solve)
  double external_work = 0.0;    // J/m since t = 0
  double released = 0.0;         // J/m since t = 0
  double initial_energy = 0.0;   // J/m before the boundary moved
  double initial_surface = 0.0;  // J/m of the initial cracks
  long long sweeps = 0;          // of the psi equation since t = 0
};

enum class Stage { move, history, damage, degrade, force, ledger };
inline constexpr std::array<const char*, 6> stage_names{"move", "history", "damage", "degrade", "force", "ledger"};

struct Scratch {
  std::array<Field, 4> reduction;
  std::vector<unsigned char> row_yields;
  Field source, inverse_diagonal, stored, stored_before, g, fx, fz, psi_other;
  Field rows;                      // scratch_rows rows for the kernels
  std::vector<double> held_force;  // force on held nodes before the step, in the order of the motions
  StressSum stress{};              // N, after the last force
  EnergyDrop drop{};               // of the last step
  StageClock<Stage, stage_names.size()> clock{};
};

State make_state(const Model& model);
Scratch make_scratch(const Model& model);

// The kernels' view of all fields.
View view(const Model& model, State& state, Scratch& scratch);

}  // namespace fracfarm::phasefield
