// What is constant in a run of the assembled path: grid, element, laws by row of elements, masses, told displacements, cracks.
// Fields are plain vectors: node n = row * columns + column, its displacements at 2 n (x) and 2 n + 1 (z).
#pragma once

#include <functional>
#include <vector>

#include "common/base/result.hpp"
#include "solver/boundary.hpp"
#include "solver/law/surface.hpp"
#include "solver/phasefield/assembled/point_law.hpp"
#include "solver/phasefield/grid.hpp"

namespace fracfarm::phasefield::assembled {

using Vector = Eigen::VectorXd;

struct ElementRow {
  PointLaw law;
  law::SurfaceLaw<double> surface;
  double Gc = 0.0;       // J/m^2
  double width = 0.0;    // w_0, m
  double density = 0.0;  // kg/m^3
};

// A displacement that is told: node and axis.
struct Told {
  int column = 0;
  int row = 0;
  Axis axis = Axis::x;
};

// For boundary conditions that no scene can say: these displacements follow `displacement` (m, of the k-th one at a time in s), besides
// those that the scene's loads move.
struct Prescription {
  std::vector<Told> told;
  std::function<double(std::size_t k, double time)> displacement;
};

struct Model {
  Grid grid;
  PhaseFieldSettings settings;
  Element element;
  std::vector<ElementRow> element_rows;
  bool linear = true;  // no law needs Newton's iterations
  bool yields = false;
  Vector mass;  // lumped, by displacement, kg/m
  Boundary boundary;
  Prescription prescription;
  std::vector<std::size_t> supports;  // displacements held at their place so that a quasi-static body cannot drift
  std::vector<int> equation;          // by displacement: its place among the free ones, or -1 where it is told
  int equations = 0;
  std::vector<unsigned char> mask;  // by node: 1 where psi is held at 1
  std::vector<int> psi_equation;
  int psi_equations = 0;
  std::vector<double> first_history;   // H at the points at t = 0, J/m^3
  std::vector<unsigned char> cut_out;  // by element: 1 where there is no material, a notch with faces that no scene can say; empty: none
  double stable_dt = 0.0;              // s, of the explicit scheme
  double damage_tolerance = 1e-10;     // residual of the psi equation over its right side

  int nodes() const { return grid.columns * grid.rows; }
  int elements() const { return grid.cells_x() * grid.cells_z(); }
  bool is_cut_out(int e) const { return !cut_out.empty() && cut_out[static_cast<std::size_t>(e)]; }
  int node(int column, int row) const { return row * grid.columns + column; }
  std::array<int, 4> nodes_of(int i, int j) const { return {node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)}; }
};

Model build_model(const Scene& scene, Prescription prescription = {});

}  // namespace fracfarm::phasefield::assembled
