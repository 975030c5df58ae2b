// The loops over the grid, compiled once for each instruction set from the same sources (kernels/) and chosen when a run starts.
// Every path gives the same bits: no contraction, and sums of a row are made of `lanes` partial sums added in a fixed order.
#pragma once

#include <span>
#include <string_view>

#include "solver/law/elastic.hpp"
#include "solver/law/secant.hpp"

namespace fracfarm::phasefield {

// Constants of one row of elements.
struct ElementRow {
  law::Stiffness<double> stiffness;
  law::Secant<double> secant;  // where plastic
  bool plastic;
  double surface;        // G_c / w_0, J/m^3
  double surface_slope;  // G_c w_0, J/m
  double width;          // w_0, m
};

// Coefficients of the psi equation at one row of nodes, scaled as for an interior node: sides are mirrored there.
struct NodeRow {
  double side;  // of the left and the right neighbour
  double south;
  double north;
  double diagonal;  // without the history's part
};

// Raw pointers to node (0, 0), or element (0, 0), of each field: what every kernel sees. Strides in doubles.
struct View {
  int columns, rows, padded, stride;
  double hx, hz, corner_area, eta;
  const ElementRow* element_rows;
  const NodeRow* node_rows;
  const double *mass, *inverse_mass_x, *inverse_mass_z;  // kg/m, m/kg; inverse is 0 where the velocity is given
  double *ux, *uz, *vx, *vz;                             // m, m/s (half a step back)
  double* history[4];                                    // H at the corners sw se nw ne of each element, J/m^3
  double* reduction[4];                                  // s at the same corners, valid in rows that yield
  unsigned char* row_yields;                             // by element row
  double* source;                                        // 2 H weighted, right side of the psi equation
  double* inverse_diagonal;
  double* stored;         // undegraded stored energy around a node, J/m
  double* stored_before;  // the same one step earlier
  double* g;              // degradation
  double *fx, *fz;        // internal force, N/m
  double* scratch;        // scratch_rows rows for row results
};
inline constexpr int scratch_rows = 12;

struct EnergyDrop {
  double
      released;    // by the change of g at fixed strain, J/m: geometric mean of the strain energies before and after the step, second order
  double elastic;  // stored with the new g, J/m
};

struct StressSum {
  double xx, zz;  // integral of the degraded stress over the sample, N
};

struct SurfaceSum {
  double local;     // integral of G_c psi^2 / (2 w_0), J/m
  double gradient;  // integral of G_c w_0 |grad psi|^2 / 2, J/m
  double length;    // integral of w_0 |grad psi|^2, m
};

struct Kernels {
  std::string_view isa;
  // v += dt f / m, u += dt v.
  void (*move)(const View&, double dt);
  // H = max(H, Phi+(epsilon)) and stored energy at all corners; source of the psi equation.
  void (*update_history)(const View&);
  // inverse_diagonal from source.
  void (*set_diagonal)(const View&);
  // guess = 2 psi - previous in both `previous` and `other`.
  void (*extrapolate)(const View&, const double* psi, double* previous, double* other);
  // other += omega (z - other) with z the Jacobi image of psi; returns max |z - psi|. Mirrors `other` into its ghost columns.
  double (*sweep)(const View&, const double* psi, double* other, double omega);
  // New g from psi.
  EnergyDrop (*degrade)(const View&, const double* psi);
  // Internal forces f = -B^T sigma.
  StressSum (*internal_force)(const View&);
  // 1/2 m (v + half_dt f / m)^2, J/m.
  double (*kinetic)(const View&, double half_dt);
  SurfaceSum (*surface)(const View&, const double* psi);
};

// Paths that this processor runs, best first; the last is the baseline, which every processor runs.
std::span<const Kernels* const> runnable_kernels();

// The best runnable path, or the one that the environment variable FRACFARM_ISA (baseline, v3, v4) names where it runs here.
const Kernels& chosen_kernels();

}  // namespace fracfarm::phasefield
