// What is constant in a run: grid, material by element row, held nodes, boundary conditions. Built once from a scene.
#pragma once

#include <vector>

#include "common/scene/scene.hpp"
#include "solver/boundary.hpp"
#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"

namespace fracfarm::phasefield {

// Largest |z - psi| over the nodes at which a damage field is accepted, z its Jacobi image; the error of psi is then at most this / (1 -
// radius).
inline constexpr double damage_tolerance = 1e-8;

struct Model {
  Grid grid;
  double eta = 0.0;
  std::vector<ElementRow> element_rows;
  std::vector<NodeRow> node_rows;
  Field mass, inverse_mass_x, inverse_mass_z;
  std::vector<unsigned char> mask;  // columns * rows: 1 where psi is held at 1
  std::vector<std::size_t> pinned;  // the same nodes as indices of a Field
  Boundary boundary;
  double stable_dt = 0.0;                                  // s; edge of the central difference scheme
  double jacobi_radius = 0.0;                              // bound of the Jacobi iteration's spectral radius
  double damage_tolerance = phasefield::damage_tolerance;  // only verification asks for another
};

Model build_model(const Scene& scene);

// h / sqrt((C_max + C55) / rho) on squares; on rectangles the smaller of (C11/hx^2 + C55/hz^2) and (C33/hz^2 + C55/hx^2) at sqrt(rho / .).
double stable_dt(const law::Stiffness<double>& C, double density, double hx, double hz);

}  // namespace fracfarm::phasefield
