// State: exactly what a restart needs. Scratch: what follows from it, allocated before the loop.
#pragma once

#include <vector>

#include "solver/phasefield/assembled/linear.hpp"
#include "solver/phasefield/assembled/model.hpp"
#include "solver/stage_clock.hpp"

namespace fracfarm::phasefield::assembled {

struct State {
  Vector u;                      // m
  Vector v;                      // m/s; explicit scheme: half a step before u
  Vector a;                      // m/s^2; Newmark's only
  Vector psi, psi_previous;      // by node, of this step and the one before
  std::vector<double> history;   // H at the points, four for each element, J/m^3
  std::vector<Plastic> plastic;  // at the points, where a law yields
  double external_work = 0.0;    // J/m since t = 0
  double released = 0.0;
  double plastic_work = 0.0;
  double initial_energy = 0.0;   // J/m before the boundary moved
  double initial_surface = 0.0;  // J/m of the initial cracks
  double largest_force = 0.0;    // N/m, what residuals are measured by
  long long iterations = 0;      // of the psi equation since t = 0
  long long passes = 0;          // staggered, since t = 0
};

enum class Stage { move, history, damage, degrade, force, ledger };
inline constexpr std::array<const char*, 6> stage_names{"move", "history", "damage", "degrade", "force", "ledger"};

struct StressSum {
  double xx = 0.0, zz = 0.0;  // integral of the degraded stress over the sample, N
};

struct Scratch {
  std::vector<Response> now, before;  // at the points: of u as it is, and at the end of the step before
  std::vector<double> g, g_before;    // degradation at the points
  std::vector<double> history;        // with the drive of u as it is
  Vector force, force_before;         // -B^T sigma + tractions, N/m
  Vector u_before;
  double force_scale = 0.0;           // norm of the elements' own forces, N/m
  StressSum stress;                   // with force
  SymmetricMatrix stiffness, damage;  // pattern and values
  Vector damage_source;
  std::vector<double> stiffness_g;  // g and inertia that the stiffness was assembled with, where that is all it depends on
  double stiffness_inertia = 0.0;
  FactoredSolver displacement_solver;
  StageClock<Stage, stage_names.size()> clock{};
};

State make_state(const Model& model);
Scratch make_scratch(const Model& model);

}  // namespace fracfarm::phasefield::assembled
