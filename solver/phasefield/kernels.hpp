// The work on one row of nodes, compiled once for each instruction set and number type from the same sources (kernels/) and chosen when a
// run starts; which row when is the business of passes.cpp. Every path gives the same bits: no contraction, and a row's sum is made of
// `lanes` partial sums added in a fixed order.
//
// Everything is integrated at the corners of the elements, so that a node owns the four corners that meet in it: its quadrants sw se nw ne.
// Outside the grid lie ghosts: rows of elements without stiffness below and above; columns of nodes left and right, placed so that the
// outer quadrants of a side node mirror its inner ones and count for nothing.
#pragma once

#include <span>
#include <string_view>

#include "solver/law/elastic.hpp"
#include "solver/law/secant.hpp"

namespace fracfarm::phasefield {

// Which law the rows follow; secant plasticity goes with the first two.
enum class RowLaw { seed, none, spectral, star_convex };

// Constants of one row of elements.
template <class Real>
struct ElementRow {
  law::Stiffness<Real> stiffness{};
  law::Secant<Real> secant{Real(0), Real(0), Real(1), Real(0)};  // mu = 0 where not plastic
  bool plastic = false;
  Real lambda{}, mu{}, per_dimensions{}, star_convexity{};  // of the splits for isotropic materials, see law/splits.hpp
  Real surface_square{}, surface_linear{};                  // J/m^3, of psi^2 and psi in the surface functional
  Real surface_gradient{};                                  // J/m, of |grad psi|^2
  Real surface_length{};                                    // m, of |grad psi|^2 in the crack length
};

// Coefficients at one row of nodes, as for an interior node: sides are mirrored there.
template <class Real>
struct NodeRow {
  Real side{};  // psi equation: of the left and the right neighbour, J/m
  Real south{};
  Real north{};
  Real diagonal{};   // without the history's part
  Real weight{};     // m^2, of the sum of H over the quadrants, both in the diagonal and on the right
  Real threshold{};  // J/m, taken from the right side
  Real mass{};       // kg/m
};

// A traction's force on a node of a row, N/m.
template <class Real>
struct NodeForce {
  int column = 0;
  Real x{}, z{};
};

// Raw pointers to node (0, 0) of each field: what every kernel sees. Strides in numbers.
template <class Real>
struct View {
  int columns, rows, padded, stride;
  double hx, hz, corner_area;
  Real eta;
  RowLaw law;
  bool keeps_forces;                     // all of fx and fz are stored; else only those of the sides
  bool tests_yield;                      // tiles that may yield are tested; else all of them run the secant law
  const ElementRow<Real>* element_rows;  // [j] is below node row j, [j + 1] above it
  const NodeRow<Real>* node_rows;        // [j]
  const Real* column_weight;             // 1 inside, 1/2 at the sides, 0 in the pad
  const Real* const* inverse_mass_x;     // [j][i], m/kg; 0 where the velocity is given
  const Real* const* inverse_mass_z;
  const int *pin_begin, *pins;  // columns of row j where psi = 1 is held: pins[pin_begin[j]] to pins[pin_begin[j + 1]]
  const int* node_force_begin;  // the same for
  const NodeForce<Real>* node_forces;
  const Real* whole;                // 0 at pinned nodes and in the pad, else 1
  Real *ux, *uz, *vx, *vz;          // m, m/s (half a step ahead)
  Real* history[4];                 // H in the quadrants, J/m^3
  Real* reduction[4];               // secant factor s in the quadrants, valid in rows that yield
  unsigned char* row_yields;        // by node row
  Real *source, *inverse_diagonal;  // of the psi equation
  Real *stored, *stored_before;     // undegraded energy that damage can release, summed over the quadrants, J/m^3; a step earlier
  Real *fx, *fz;                    // internal force and tractions, N/m
  Real* scratch;                    // scratch_rows rows of one thread
};
inline constexpr int scratch_rows = 40;

struct StressSum {
  double xx, zz;  // integral of the degraded stress, N
};

// What a row of nodes adds to the sums of a step.
struct RowSums {
  double released;  // J/m, by the change of g at fixed strain: geometric mean of the energies before and after the step, second order
  double elastic;   // J/m, stored with the new g, without the kept part
  StressSum stress;
};

struct SurfaceSum {
  double local;     // J/m, of psi
  double gradient;  // J/m, of its gradient
  double length;    // m, of the cracks
};

template <class Real>
struct Kernels {
  std::string_view isa;
  // u += dt v.
  void (*drift)(const View<Real>&, int j, Real dt);
  // H = max(H, drive(epsilon)), energies, and the row of the psi equation, whose pins are held; returns the kept energy, J/m. Needs u of
  // the rows j - 1 to j + 1.
  double (*history)(const View<Real>&, int j);
  // True where psi of the row's equation could rise above that of H = 0 by more than `bound` (pinned nodes apart).
  bool (*damages)(const View<Real>&, int j, Real bound);
  // previous = 2 psi - previous within [0, 1].
  void (*guess)(const View<Real>&, int j, const Real* psi, Real* previous);
  // next += omega (z - next) with z the Jacobi image of psi, or z itself where omega is 1. Needs psi of the rows j -
  // 1 to j + 1. The last sweep of a solve keeps next within [0, 1].
  double (*sweep)(const View<Real>&, int j, const Real* psi, Real* next, Real omega, bool last);
  // One sweep of the row in place, with omega 1 and within [0, 1].
  double (*settle)(const View<Real>&, int j, Real* psi);
  // g of psi, and what the row's quadrants give to the forces of rows j - 1 to j + 1. Needs u of these. `before` is psi one step earlier.
  RowSums (*force)(const View<Real>&, int j, const Real* psi, const Real* before);
  // f of row j, once force() has seen the rows j - 1 to j + 1 (forget() stands for those outside); v += dt f / m. Returns the kinetic
  // energy of the mean velocity, J/m.
  double (*kick)(const View<Real>&, int j, Real dt);
  // The quadrants of a row outside the grid give nothing.
  void (*forget)(const View<Real>&, int j);
  // Surface functional of element row j.
  SurfaceSum (*surface)(const View<Real>&, int j, const Real* psi);
};

// Paths that this processor runs, best first; the last is the baseline, which every processor runs.
template <class Real>
std::span<const Kernels<Real>* const> runnable_kernels();

// The best runnable path, or the one that the environment variable FRACFARM_ISA (baseline, v3, v4) names where it runs here.
template <class Real>
const Kernels<Real>& chosen_kernels();

}  // namespace fracfarm::phasefield
