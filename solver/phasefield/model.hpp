// What is constant in a run: grid, material by element row, held nodes, boundary conditions. Built once from a scene.
#pragma once

#include <vector>

#include "common/scene/scene.hpp"
#include "solver/boundary.hpp"
#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"

namespace fracfarm::phasefield {

struct Model {
  Grid grid;
  double eta = 0.0;
  std::vector<ElementRow> element_rows;
  std::vector<NodeRow> node_rows;
  Field mass, inverse_mass_x, inverse_mass_z;
  std::vector<unsigned char> mask;  // columns * rows: 1 where psi is held at 1
  std::vector<std::size_t> pinned;  // the same nodes as indices of a Field
  Boundary boundary;
  double stable_dt = 0.0;      // s; edge of the central difference scheme
  double jacobi_radius = 0.0;  // bound of the Jacobi iteration's spectral radius
};

Model build_model(const Scene& scene);

// h / sqrt((C_max + C55) / rho) on squares; on rectangles the smaller of (C11/hx^2 + C55/hz^2) and (C33/hz^2 + C55/hx^2) at sqrt(rho / .).
double stable_dt(const law::Stiffness& C, double density, double hx, double hz);

}  // namespace fracfarm::phasefield
