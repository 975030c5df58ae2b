// What is constant in a run, in double: grid, material by element row, held nodes, boundary conditions. Built once from a scene.
#pragma once

#include <vector>

#include "common/scene/scene.hpp"
#include "solver/boundary.hpp"
#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/rules.hpp"

namespace fracfarm::phasefield {

inline constexpr int most_damage_sweeps = 16;

struct Model {
  Grid grid;
  double eta = 0.0;
  RowLaw law = RowLaw::seed;
  std::vector<ElementRow<double>> element_rows;  // from the bottom up between two ghosts without stiffness
  std::vector<NodeRow<double>> node_rows;
  std::vector<double> first_history;  // J/m^3, H at t = 0 by element: the surface law's floor, or a seeded crack; empty where all are 0
  Field<double> mass, inverse_mass_x, inverse_mass_z;
  std::vector<unsigned char> mask;  // columns * rows: 1 where psi is held at 1
  std::vector<std::size_t> pinned;  // the same nodes as indices of a field
  Boundary boundary;
  double stable_dt = 0.0;         // s; edge of the central difference scheme
  double jacobi_radius = 0.0;     // bound of the Jacobi iteration's spectral radius
  double damage_tolerance = 0.0;  // largest |z - psi| of a row's last sweep, z the Jacobi image of psi
  int damage_sweeps = 0;          // of the whole grid in a step, at least; more where the tolerance asks for it
  double moved_damage = 0.0;      // of psi in rest_steps steps; what moves less rests, see passes.hpp
  Rules rules;
  bool keeps_forces = false;  // verification: forces of all nodes are stored, not of the sides only
};

Model build_model(const Scene& scene);

}  // namespace fracfarm::phasefield
