// State: exactly what a restart needs. Scratch: everything that follows from it and the model, allocated before the loop.
#pragma once

#include <array>
#include <vector>

#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/phasefield/model.hpp"
#include "solver/stage_clock.hpp"

namespace fracfarm::phasefield {

struct StressSum {
  double xx, zz;  // integral of the degraded stress, N
};

// Sums over the body after a step.
struct StepSums {
  StressSum stress{};    // N
  double elastic = 0.0;  // J/m, stored with the new g
  double kinetic = 0.0;  // J/m
};

template <class Real>
struct State {
  Field<Real> ux, uz;                        // m
  Field<Real> vx, vz;                        // m/s, half a step ahead of the displacements
  std::array<Field<Real>, 4> history;        // H in the quadrants sw se nw ne of each node, J/m^3; see set_history
  Field<Real> psi, psi_previous;             // of this step and the one before (its extrapolation starts the next solve)
  Field<Real> stored;                        // see View
  std::vector<unsigned char> moves, yields;  // by tile, see View
  bool whole = true;                         // the last step worked on all tiles
  StepSums sums;
  bool damages = false;          // psi could have risen since t = 0
  double external_work = 0.0;    // J/m since t = 0
  double released = 0.0;         // J/m since t = 0
  double initial_energy = 0.0;   // J/m before the boundary moved
  double initial_surface = 0.0;  // J/m of the initial cracks
  int planned_sweeps = 0;        // of psi in the next step
  long long sweeps = 0;          // of the psi equation since t = 0
};

enum class Stage { drive, damage, force, ledger };
inline constexpr std::array<const char*, 4> stage_names{"drive", "damage", "force", "ledger"};

// Runs of tiles by row of nodes.
struct RunList {
  std::vector<int> begin;
  std::vector<Run> runs;
};

// The model's constants as the kernels want them.
template <class Real>
struct Tables {
  std::vector<ElementRow<Real>> element_rows;
  std::vector<NodeRow<Real>> node_rows;
  RunList whole_rows;
  std::vector<Run> strips;        // of rows that are kicked together: of one kind among elements of one kind, or one row
  std::vector<Run> surface_rows;  // rows whose elements below are of one surface law, and those above
  Field<Real> column_weight, whole;
  std::vector<Field<Real>> inverse_masses;  // rows; equal ones are stored once
  std::vector<const Real*> inverse_mass_x, inverse_mass_z;
  std::vector<int> pin_begin, pins, node_force_begin;
  std::vector<NodeForce<Real>> node_forces;  // as of the last step
};

template <class Real>
struct Scratch {
  Tables<Real> tables;
  std::vector<unsigned char> gives;  // see View; from row -1 on
  RunList moving;                    // tiles that light steps work on
  Field<Real> source, inverse_diagonal, stored_before, degradation, fx, fz, psi_other;
  Field<Real> rows;                            // scratch_rows rows for the kernels
  std::vector<double> held_force;              // by motion: sum of the forces on its nodes after the last step, N/m
  std::vector<Real> held_velocity;             // by motion: of its nodes, m/s; not a number before it is set
  std::vector<double> change;                  // by row: correction of its last sweep
  std::vector<int> unsettled_rows, rows_near;  // where it is too large; these and those beside them
  long long solves = 0, last_whole = 0;        // of psi so far, and the last one of all tiles, as CrackMarks counts them
  double kept = 0.0;                           // J/m, energy that damage cannot release
  double released = 0.0;                       // J/m, in the last step
  StageClock<Stage, stage_names.size()> clock{};
};

template <class Real>
State<Real> make_state(const Model& model);
template <class Real>
Scratch<Real> make_scratch(const Model& model);

// The runs of the tiles that move, from their flags. A tile between two runs joins them and moves, too.
template <class Real>
void find_moving(const Grid& grid, State<Real>& state, Scratch<Real>& scratch);

// The kernels' view of all fields.
template <class Real>
View<Real> view(const Model& model, State<Real>& state, Scratch<Real>& scratch);

// The entry of a node that carries a traction, by its index in a field.
template <class Real>
NodeForce<Real>& node_force(const Grid& grid, Tables<Real>& tables, std::size_t index);

// H at a corner (sw se nw ne) of element (column, row): in the quadrant of the node there, and mirrored outside the sides. J/m^3.
template <class Real>
void set_history(const Grid& grid, State<Real>& state, int column, int row, int corner, Real value);
template <class Real>
Real history_at(const Grid& grid, const State<Real>& state, int column, int row, int corner);

}  // namespace fracfarm::phasefield
