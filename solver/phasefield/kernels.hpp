// The work on one row of nodes, or a strip of them, compiled once for each instruction set and number type from the same sources (kernels/)
// and chosen when a run starts; which row when is the business of passes.cpp. Every path gives the same bits: no contraction, and a sum is
// made of `lanes` partial sums added in a fixed order.
//
// Everything is integrated at the corners of the elements, so that a node owns the four corners that meet in it: its quadrants sw se nw ne.
// Outside the grid lie ghosts: rows of elements without stiffness below and above; columns of nodes left and right, placed so that the
// outer quadrants of a side node mirror its inner ones and count for nothing.
#pragma once

#include <span>
#include <string_view>

#include "solver/law/elastic.hpp"
#include "solver/phasefield/grid.hpp"

namespace fracfarm::phasefield {

// Which law the rows follow; secant plasticity goes with the first two.
enum class RowLaw { seed, none, spectral, star_convex };

// Moduli for differences of displacements along the edges in place of strains; `shear` goes with one difference in x and one in z.
template <class Real>
struct Differenced {
  Real c11{}, c33{}, c13{}, c55{}, shear{};
};

// The secant law of a row of elements in differences of displacements. With p = (q / sigma_y)^2, a quadratic form of the strain, and
// r = sigma_y / q past yield, else 1, yielding takes the share (1 - h) (1 - r) of mu: the drive loses `drive` (1 - r) p of the strain that
// drives, and the potential `energy` (q / sigma_y - 1)^2, see law::stored_energy. All are 0 where the row does not yield at all.
template <class Real>
struct Yielding {
  Real normal_x{}, normal_z{}, cross{}, shear{};  // of p
  Real soft{};                                    // 1 - h
  Real drive{}, energy{};                         // J/m^3
};

// Constants of one row of elements.
template <class Real>
struct ElementRow {
  law::Stiffness<Real> stiffness{};
  bool plastic = false;
  Differenced<Real> energy;  // J/m^5: half the stiffness per squared spacing; c13 whole
  Differenced<Real> force;   // N/m^2: times the corner's area
  Yielding<Real> yielding;
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
  Real diagonal{};            // without the history's part
  Real weight{};              // m^2, of the sum of H over the quadrants, both in the diagonal and on the right
  Real threshold{};           // J/m, taken from the right side
  Real mass{};                // kg/m
  bool amid = false;          // the elements below and above are of one kind
  Real along_x{}, along_z{};  // N/m^2, of the edges along x: stiffness against u_x, u_z
};

// A traction's force on a node of a row, N/m.
template <class Real>
struct NodeForce {
  int column = 0;
  Real x{}, z{};
};

// Neighbouring tiles (groups of `lanes` nodes) of a row: nodes begin to end.
struct Run {
  int begin, end;
};

// Raw pointers to node (0, 0) of each field: what every kernel sees. Strides in numbers.
template <class Real>
struct View {
  int columns, rows, padded, stride, tiles;
  double hx, hz, corner_area;
  Real eta;
  RowLaw law;
  bool keeps_forces;     // all of fx and fz are stored; else only those of the sides
  bool tests_yield;      // tiles that may yield are tested; else all of them run the secant law
  const int* run_begin;  // the tiles of row j that are worked on: runs[run_begin[j]] to runs[run_begin[j + 1]]
  const Run* runs;
  Real moved_damage;                     // a tile moves whose psi changes by more than this in rest_steps steps
  unsigned char* moves;                  // by tile [j tiles + t], t a group of `lanes` nodes; what it is for: see passes.hpp
  unsigned char* yields;                 // by tile: does_yield or nearly_yields, as of the last step that looked
  const ElementRow<Real>* element_rows;  // [j] is below node row j, [j + 1] above it
  const NodeRow<Real>* node_rows;        // [j]
  const Real* column_weight;             // 1 inside, 1/2 at the sides, 0 in the pad
  const Real* const* inverse_mass_x;     // [j][i], m/kg; 0 where the velocity is given
  const Real* const* inverse_mass_z;
  const int *pin_begin, *pins;  // columns of row j where psi = 1 is held: pins[pin_begin[j]] to pins[pin_begin[j + 1]]
  const int* node_force_begin;  // the same for
  const NodeForce<Real>* node_forces;
  const Real* whole_nodes;          // 0 at pinned nodes and in the pad, else 1
  Real *ux, *uz, *vx, *vz;          // m, m/s (half a step ahead)
  Real* history[4];                 // H in the quadrants, J/m^3
  Real *source, *inverse_diagonal;  // of the psi equation
  Real *stored, *stored_before;     // undegraded energy that damage can release, summed over the quadrants, J/m^3, when a tile was last
                                    // worked on, and a step before that
  Real* degradation;                // g of psi
  unsigned char* gives;             // by tile, of rows from -1 to `rows`: what its quadrants gave to the forces around
  Real *fx, *fz;                    // internal force and tractions, N/m
  Real* scratch;                    // scratch_rows rows of one thread
};
inline constexpr int scratch_rows = 243;
inline constexpr int strip_rows = 21;                                              // that are kicked together, at most
inline constexpr unsigned char gives_nothing = 0, gives_parts = 1, gives_all = 2;  // parts: at the ends, what the tile beside gives
inline constexpr unsigned char does_yield = 1, nearly_yields = 2;                  // flags of a tile
inline constexpr int rest_steps = 4;                                               // a whole step and the light ones after it

// A sum over nodes, in parts: number l of each tile goes to part l.
struct alignas(64) Parts {
  double at[lanes]{};
  double total() const;  // in a fixed order
};

// What rows of nodes add up to in a step.
struct Sums {
  Parts released;  // J/m, by the change of g at fixed strain: geometric mean of the energies before and after the step, second order
  Parts elastic;   // J/m, stored with the new g, without the kept part; of the tiles that are worked on
  Parts stress_xx, stress_zz;  // N, integrals of the degraded stress
  Parts kinetic;               // J/m, of the mean velocity
};

// The surface functional.
struct SurfaceParts {
  Parts local;     // J/m, of psi
  Parts gradient;  // J/m, of its gradient
  Parts length;    // m, of the cracks
};
struct SurfaceSum {
  double local, gradient, length;
};

template <class Real>
struct Kernels {
  std::string_view isa;
  // u += dt v.
  void (*drift)(const View<Real>&, int j, Real dt);
  // H = max(H, drive(epsilon)), energies, and the row of the psi equation, whose pins are held; returns the kept energy, J/m. Needs u of
  // the rows j - 1 to j + 1. Of tiles that are worked on, as all that follows but kick() and surface().
  double (*history)(const View<Real>&, int j);
  // The row of the psi equation from H as it is: history() keeps it up to date from then on.
  void (*equation)(const View<Real>&, int j);
  // True where psi of the row's equation could rise above that of H = 0 by more than `bound` (pinned nodes apart).
  bool (*damages)(const View<Real>&, int j, Real bound);
  // previous = 2 psi - previous within [0, 1].
  void (*guess)(const View<Real>&, int j, const Real* psi, Real* previous);
  // next += omega (z - next) with z the Jacobi image of psi, or z itself where omega is 1. Needs psi of the rows j -
  // 1 to j + 1. The last sweep of a solve keeps next within [0, 1].
  double (*sweep)(const View<Real>&, int j, const Real* psi, Real* next, Real omega, bool last);
  // One sweep of the row in place, with omega 1 and within [0, 1].
  double (*settle)(const View<Real>&, int j, Real* psi);
  // Which tiles of the row move, judged by the last step, which was whole. Psi of those that rest is put into all three fields.
  void (*rest)(const View<Real>&, int j, const Real* psi, Real* previous, Real* other);
  // Energy that the row stores with the g that it has, J/m, with the seed's law: of tiles that rest, too.
  double (*elastic_energy)(const View<Real>&, int j);
  // g of psi in some rows. `before` is psi one step earlier.
  void (*degrade)(const View<Real>&, int begin, int end, const Real* psi, const Real* before, Sums&);
  // What the rows' quadrants give to the forces there and in the rows around beyond linear elasticity. Needs g, and u around.
  void (*force)(const View<Real>&, int begin, int end, Sums&);
  // f of the rows of a strip (see Tables), and v += dt f / m, once force() has seen the rows first - 1 to end. Needs u and g of these rows.
  void (*kick)(const View<Real>&, int first, int end, Real dt, Sums&);
  // Surface functional: what the nodes of some rows among elements of one surface law (see Tables), and the edges along these rows and up
  // to the next, add to it.
  void (*surface)(const View<Real>&, int begin, int end, const Real* psi, SurfaceParts&);
  // True where a mark is not what `psi > limit` is at its node.
  bool (*differs)(const Real* psi, Real limit, const unsigned char* marks, int count);
};

// Paths that this processor runs, best first; the last is the baseline, which every processor runs.
template <class Real>
std::span<const Kernels<Real>* const> runnable_kernels();

// The best runnable path, or the one that the environment variable FRACFARM_ISA (baseline, v3, v4) names where it runs here.
template <class Real>
const Kernels<Real>& chosen_kernels();

}  // namespace fracfarm::phasefield
