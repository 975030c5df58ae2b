// What the kernels share: strains at the corners of an element row, ordered sums, scratch rows. Included by the kernels only, which are
// compiled once for each instruction set; everything is inlined, so that no instruction of a higher set leaks into shared code. Corners of
// an element: sw se nw ne; the strain at a corner uses the two sides of the element that meet there (Gauss-Lobatto corner quadrature).
#pragma once

#include "solver/phasefield/grid.hpp"
#include "solver/phasefield/kernels.hpp"

#define INLINE [[gnu::always_inline]] inline

namespace fracfarm::phasefield::FRACFARM_ISA {

using Stiffness = law::Stiffness<double>;
using Strain = law::Strain<double>;
using Stress = law::Stress<double>;
using Index = long;

struct Corners {
  Strain sw, se, nw, ne;
};

// Displacements of the two node rows of an element row.
struct RowPair {
  const double *ux0, *uz0, *ux1, *uz1;
  double per_hx, per_hz;
};

INLINE RowPair row_pair(const View& v, int j) {
  const Index at = Index(j) * v.stride;
  return {v.ux + at, v.uz + at, v.ux + at + v.stride, v.uz + at + v.stride, 1.0 / v.hx, 1.0 / v.hz};
}

INLINE Corners corner_strains(const RowPair& r, Index i) {
  const double xx_south = (r.ux0[i + 1] - r.ux0[i]) * r.per_hx, xx_north = (r.ux1[i + 1] - r.ux1[i]) * r.per_hx;
  const double zz_west = (r.uz1[i] - r.uz0[i]) * r.per_hz, zz_east = (r.uz1[i + 1] - r.uz0[i + 1]) * r.per_hz;
  const double zx_south = (r.uz0[i + 1] - r.uz0[i]) * r.per_hx, zx_north = (r.uz1[i + 1] - r.uz1[i]) * r.per_hx;
  const double xz_west = (r.ux1[i] - r.ux0[i]) * r.per_hz, xz_east = (r.ux1[i + 1] - r.ux0[i + 1]) * r.per_hz;
  return {{xx_south, zz_west, xz_west + zx_south},
          {xx_south, zz_east, xz_east + zx_south},
          {xx_north, zz_west, xz_west + zx_north},
          {xx_north, zz_east, xz_east + zx_north}};
}

INLINE double larger(double a, double b) { return a > b ? a : b; }

// Sum of n (a multiple of `lanes`) numbers: `lanes` partial sums, then pairs.
INLINE double ordered_sum(const double* __restrict x, Index n) {
  double part[lanes] = {};
  for (Index i = 0; i < n; i += lanes)
    for (int l = 0; l < lanes; ++l) part[l] += x[i + l];
  return ((part[0] + part[4]) + (part[2] + part[6])) + ((part[1] + part[5]) + (part[3] + part[7]));
}

INLINE double* scratch_row(const View& v, int k) { return v.scratch + Index(k) * v.stride; }

// Element results of a row end at the last element: what the padded loop left behind it must not count.
INLINE void clear_pad(const View& v, double* row) {
  for (Index i = v.columns - 1; i < v.padded; ++i) row[i] = 0.0;
}

}  // namespace fracfarm::phasefield::FRACFARM_ISA
