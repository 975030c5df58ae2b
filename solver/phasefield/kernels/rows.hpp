// What the kernels share: the row of nodes with its neighbours, strains in its quadrants, ordered sums, scratch rows. Included by the
// kernels only, which are compiled once for each instruction set and number type; everything is inlined, so that no instruction of a higher
// set leaks into shared code.
#pragma once

#include <cmath>

#include "solver/law/splits.hpp"
#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/phasefield/kernels/wide.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {

using View = phasefield::View<Real>;
using ElementRow = phasefield::ElementRow<Real>;
using NodeRow = phasefield::NodeRow<Real>;
using Stiffness = law::Stiffness<Real>;
using Strain = law::Strain<Real>;
using Stress = law::Stress<Real>;

INLINE Index row_at(const View& v, int j) { return Index(j) * v.stride; }
INLINE Real larger(Real a, Real b) { return a > b ? a : b; }
INLINE Real smaller(Real a, Real b) { return a < b ? a : b; }

// Displacements around a row of nodes.
struct Around {
  const Real *x, *x_south, *x_north, *z, *z_south, *z_north;
};

INLINE Around around(const View& v, int j) {
  const Real *x = v.ux + row_at(v, j), *z = v.uz + row_at(v, j);
  return {x, x - v.stride, x + v.stride, z, z - v.stride, z + v.stride};
}

// body(i) over a row. What a simd loop itself declares may end up in memory and keep it scalar; what `body` declares does not.
template <class Body>
INLINE void along_row(Index n, const Body& body) {
#pragma omp simd
  for (Index i = 0; i < n; ++i) body(i);
}
#define ROW_BODY [=](Index i) __attribute__((always_inline))

// The same by tiles of `lanes` nodes, for bodies that sum: body(i, l) with l the node's number in its tile. Loops of just as many turns as
// an instruction has numbers become straight code.
template <class Body>
INLINE void along_tile(Index tile, const Body& body) {
  for (Index part = 0; part < lanes; part += width) {
#pragma omp simd
    for (Index l = part; l < part + width; ++l) body(tile + l, l);
  }
}
template <class Body>
INLINE void along_tiles(Index n, const Body& body) {
  for (Index tile = 0; tile < n; tile += lanes) along_tile(tile, body);
}
#define TILE_BODY [&](Index i, [[maybe_unused]] Index l) __attribute__((always_inline))

// body(tile, flag) for the tiles of a row that are worked on: its first node, and where its flags are.
template <class Body>
INLINE void over_tiles(const View& v, int j, const Body& body) {
  const Run *run = v.runs + v.run_begin[j], *last = v.runs + v.run_begin[j + 1];
  const Index first = Index(j) * v.tiles;
  for (; run < last; ++run)
    for (Index tile = run->begin, end = run->end; tile < end; tile += lanes) body(tile, first + tile / lanes);
}
template <class Body>
INLINE void along_worked_tiles(const View& v, int j, const Body& body) {
  over_tiles(
      v, j, [&](Index tile, Index) __attribute__((always_inline)) { along_tile(tile, body); });
}

struct Quadrants {
  Strain sw, se, nw, ne;
};

INLINE Quadrants strains(const Around& u, Index i, Real per_hx, Real per_hz) {
  const Real xx_w = (u.x[i] - u.x[i - 1]) * per_hx, xx_e = (u.x[i + 1] - u.x[i]) * per_hx;
  const Real zx_w = (u.z[i] - u.z[i - 1]) * per_hx, zx_e = (u.z[i + 1] - u.z[i]) * per_hx;
  const Real zz_s = (u.z[i] - u.z_south[i]) * per_hz, zz_n = (u.z_north[i] - u.z[i]) * per_hz;
  const Real xz_s = (u.x[i] - u.x_south[i]) * per_hz, xz_n = (u.x_north[i] - u.x[i]) * per_hz;
  return {{xx_w, zz_s, xz_s + zx_w}, {xx_e, zz_s, xz_s + zx_e}, {xx_w, zz_n, xz_n + zx_w}, {xx_e, zz_n, xz_n + zx_e}};
}

// Partial sums over a row: number l of each tile goes to sum l.
struct alignas(64) Partial {
  Real at[lanes]{};
};

static_assert(lanes == 16);
// The partial sums together: pairs.
INLINE double ordered_sum(const Partial& part) {
  Real eight[8], four[4];
  for (int l = 0; l < 8; ++l) eight[l] = part.at[l] + part.at[l + 8];
  for (int l = 0; l < 4; ++l) four[l] = eight[l] + eight[l + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
}

// The order does not matter.
INLINE Real largest(Wide x) {
  Real at[width], most = x[0];
  store(at, x);
#pragma omp simd reduction(max : most)
  for (Index l = 0; l < width; ++l) most = larger(at[l], most);
  return most;
}

// The partial sums of a row, times a factor.
INLINE void add(Parts& sum, const Partial& part, double factor) {
  for (int l = 0; l < lanes; ++l) sum.at[l] += factor * double(part.at[l]);
}

// Sum of n (a multiple of `lanes`) numbers.
INLINE double ordered_sum(const Real* __restrict x, Index n) {
  Partial part;
  for (Index i = 0; i < n; i += lanes)
    for (int l = 0; l < lanes; ++l) part.at[l] += x[i + l];
  return ordered_sum(part);
}

INLINE Real* scratch_row(const View& v, int k) { return v.scratch + Index(k) * v.stride; }

// What the quadrants of node row j give to the forces, kept until the rows around it are kicked: they act on the edges to the nodes around,
// `own` is what the nodes themselves take of it. The rows of a strip and those around it go round.
struct HalfEdges {
  Real *north_x, *north_z, *south_x, *south_z, *east_x, *east_z, *west_x, *west_z, *own_x, *own_z;
};
inline constexpr int half_edge_rows = 10, half_edge_places = strip_rows + 3, first_free_row = half_edge_places * half_edge_rows;
static_assert(first_free_row + 3 <= scratch_rows);

INLINE HalfEdges half_edges(const View& v, int j) {
  Real* row = scratch_row(v, ((j + half_edge_places) % half_edge_places) * half_edge_rows);
  const auto at = [&](Index k) { return row + k * v.stride; };
  return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), at(9)};
}

// Adds to the force of nodes i to i + width of row j what the half edges of the rows j - 1 to j + 1 give.
INLINE void add_half_edges(const View& v, int j, Index i, Wide& fx, Wide& fz) {
  const unsigned char* gives = v.gives + Index(j) * v.tiles + i / lanes;
  if (gives[0] == gives_all) {
    const HalfEdges here = half_edges(v, j);
    fx += load(here.own_x + i) + (load(here.west_x + i + 1) - load(here.east_x + i - 1));
    fz += load(here.own_z + i) + (load(here.west_z + i + 1) - load(here.east_z + i - 1));
  } else if (gives[0] == gives_parts) {
    const HalfEdges here = half_edges(v, j);
    const Index end = i + width;
    if (i % lanes == 0 && i > 0 && gives[-1] == gives_all) fx[0] -= here.east_x[i - 1], fz[0] -= here.east_z[i - 1];
    if (end % lanes == 0 && end < v.padded && gives[1] == gives_all) fx[width - 1] += here.west_x[end], fz[width - 1] += here.west_z[end];
  }
  if (gives[v.tiles] == gives_all) {
    const HalfEdges above = half_edges(v, j + 1);
    fx += load(above.south_x + i), fz += load(above.south_z + i);
  }
  if (gives[-v.tiles] == gives_all) {
    const HalfEdges below = half_edges(v, j - 1);
    fx -= load(below.north_x + i), fz -= load(below.north_z + i);
  }
}

// Laws whose quadrants are linear elastic where nothing yields.
INLINE bool is_elastic(RowLaw law) { return law == RowLaw::seed || law == RowLaw::none; }

// Internal force of the row's nodes with linear elastic quadrants; needs u and g of the rows j - 1 to j + 1.
void elastic_forces(const View& v, int j, Real* fx, Real* fz, Sums& sums);

// kick() of rows among elements of one kind without tractions, with a law that is_elastic().
void kick_strip(const View& v, int first, int end, Real dt, Sums& sums);

// Laws of the general rows, made of an element row's constants.
template <class Law>
struct LawOf;
template <>
struct LawOf<law::SpectralSplit<Real>> {
  INLINE static law::SpectralSplit<Real> make(const ElementRow& row) { return {row.lambda, row.mu}; }
};
template <>
struct LawOf<law::StarConvexSplit<Real>> {
  INLINE static law::StarConvexSplit<Real> make(const ElementRow& row) {
    return {row.lambda + Real(2) * row.mu * row.per_dimensions, row.mu, row.per_dimensions, row.star_convexity};
  }
};

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
