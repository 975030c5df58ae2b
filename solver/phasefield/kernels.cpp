// One source, compiled once for each instruction set under the namespace FRACFARM_ISA. Calls nothing that is not inlined, so that no
// instruction of a higher set leaks into shared code. Corners of an element: sw se nw ne; the strain at a corner uses the element's two
// sides that meet there (Gauss-Lobatto corner quadrature).
#include "solver/phasefield/kernels.hpp"

#include "solver/law/degradation.hpp"
#include "solver/law/seed_split.hpp"
#include "solver/phasefield/grid.hpp"

#define INLINE [[gnu::always_inline]] inline

namespace fracfarm::phasefield::FRACFARM_ISA {
namespace {

using law::Stiffness;
using law::Strain;
using law::Stress;
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

void move(const View& v, double dt) {
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
    double *ux = v.ux + at, *uz = v.uz + at, *vx = v.vx + at, *vz = v.vz + at;
    const double *fx = v.fx + at, *fz = v.fz + at, *mx = v.inverse_mass_x + at, *mz = v.inverse_mass_z + at;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      vx[i] = vx[i] + dt * (fx[i] * mx[i]);
      ux[i] = ux[i] + dt * vx[i];
      vz[i] = vz[i] + dt * (fz[i] * mz[i]);
      uz[i] = uz[i] + dt * vz[i];
    }
  }
}

// Largest q^2 of an element row.
INLINE double largest_von_mises_squared(const View& v, const law::Secant& secant, const RowPair& r) {
  double* q2 = scratch_row(v, 0);
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    q2[i] = larger(larger(law::von_mises_squared(secant, e.sw), law::von_mises_squared(secant, e.se)),
                   larger(law::von_mises_squared(secant, e.nw), law::von_mises_squared(secant, e.ne)));
  }
  clear_pad(v, q2);
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (Index i = 0; i < v.padded; ++i) largest = larger(q2[i], largest);
  return largest;
}

INLINE void elastic_history_row(const View& v, const Stiffness& C, const RowPair& r, double* const H[4], double* const W[4]) {
  double *H0 = H[0], *H1 = H[1], *H2 = H[2], *H3 = H[3], *W0 = W[0], *W1 = W[1], *W2 = W[2], *W3 = W[3];
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    H0[i] = larger(law::positive_energy(C, e.sw), H0[i]);
    H1[i] = larger(law::positive_energy(C, e.se), H1[i]);
    H2[i] = larger(law::positive_energy(C, e.nw), H2[i]);
    H3[i] = larger(law::positive_energy(C, e.ne), H3[i]);
    W0[i] = law::strain_energy(C, e.sw);
    W1[i] = law::strain_energy(C, e.se);
    W2[i] = law::strain_energy(C, e.nw);
    W3[i] = law::strain_energy(C, e.ne);
  }
}

INLINE void secant_corner(const law::Secant& secant, const Strain& e, double& H, double& W, double& s) {
  const double q = __builtin_sqrt(law::von_mises_squared(secant, e));
  s = law::reduction(secant, q);
  H = larger(law::positive_energy(law::reduced_stiffness(secant, s), e), H);
  W = law::stored_energy(secant, e, q);
}

INLINE void secant_history_row(const View& v, const law::Secant& secant, const RowPair& r, double* const H[4], double* const W[4],
                               double* const S[4]) {
  double *H0 = H[0], *H1 = H[1], *H2 = H[2], *H3 = H[3], *W0 = W[0], *W1 = W[1], *W2 = W[2], *W3 = W[3];
  double *S0 = S[0], *S1 = S[1], *S2 = S[2], *S3 = S[3];
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    secant_corner(secant, e.sw, H0[i], W0[i], S0[i]);
    secant_corner(secant, e.se, H1[i], W1[i], S1[i]);
    secant_corner(secant, e.nw, H2[i], W2[i], S2[i]);
    secant_corner(secant, e.ne, H3[i], W3[i], S3[i]);
  }
}

// Corner energies of an element row, by the node they belong to: added to the lower row, put into the upper.
INLINE void gather_stored(const View& v, int j, double* const W[4]) {
  double *lower = v.stored + Index(j) * v.stride, *upper = lower + v.stride;
  for (int k = 0; k < 4; ++k) clear_pad(v, W[k]);
  const double *sw = W[0], *se = W[1], *nw = W[2], *ne = W[3];
  const double area = v.corner_area;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    lower[i] = lower[i] + area * (sw[i] + se[i - 1]);
    upper[i] = area * (nw[i] + ne[i - 1]);
  }
}

INLINE void history_row(const View& v, int j) {
  const ElementRow& row = v.element_rows[j];
  const RowPair r = row_pair(v, j);
  const Index at = Index(j) * v.stride;
  double* const H[4] = {v.history[0] + at, v.history[1] + at, v.history[2] + at, v.history[3] + at};
  double* const W[4] = {scratch_row(v, 1), scratch_row(v, 2), scratch_row(v, 3), scratch_row(v, 4)};
  v.row_yields[j] = row.plastic && largest_von_mises_squared(v, row.secant, r) > row.secant.yield * row.secant.yield;
  if (v.row_yields[j]) {
    double* const S[4] = {v.reduction[0] + at, v.reduction[1] + at, v.reduction[2] + at, v.reduction[3] + at};
    secant_history_row(v, row.secant, r, H, W, S);
  } else {
    elastic_history_row(v, row.stiffness, r, H, W);
  }
  gather_stored(v, j, W);
}

// Right side of the psi equation at a node row: the four corners around a node, mirrored at the sides.
INLINE void source_row(const View& v, int j) {
  const bool bottom = j == 0, top = j == v.rows - 1;
  const Index above = Index(top ? j - 1 : j) * v.stride, below = Index(bottom ? j : j - 1) * v.stride;
  const double *sw = v.history[top ? 2 : 0] + above, *se = v.history[top ? 3 : 1] + above;
  const double *nw = v.history[bottom ? 0 : 2] + below, *ne = v.history[bottom ? 1 : 3] + below;
  double* source = v.source + Index(j) * v.stride;
  const double weight = 2.0 * v.corner_area;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) source[i] = weight * ((sw[i] + se[i - 1]) + (nw[i] + ne[i - 1]));
  const Index last = v.columns - 1;
  source[0] = 2.0 * weight * (sw[0] + nw[0]);
  source[last] = 2.0 * weight * (se[last - 1] + ne[last - 1]);
  for (Index i = v.columns; i < v.padded; ++i) source[i] = 0.0;
}

void update_history(const View& v) {
  for (Index i = 0; i < v.padded; ++i) v.stored[i] = 0.0;
  for (int j = 0; j + 1 < v.rows; ++j) history_row(v, j);
  for (int j = 0; j < v.rows; ++j) source_row(v, j);
}

void set_diagonal(const View& v) {
  for (int j = 0; j < v.rows; ++j) {
    const double *source = v.source + Index(j) * v.stride, diagonal = v.node_rows[j].diagonal;
    double* inverse = v.inverse_diagonal + Index(j) * v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) inverse[i] = 1.0 / (diagonal + source[i]);
  }
}

INLINE void mirror(const View& v, double* row) {
  row[-1] = row[1];
  row[v.columns] = row[v.columns - 2];
}

void extrapolate(const View& v, const double* psi, double* previous, double* other) {
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      const double guess = 2.0 * psi[at + i] - previous[at + i];
      previous[at + i] = guess;
      other[at + i] = guess;
    }
    mirror(v, previous + at);
    mirror(v, other + at);
  }
}

// z = (source + sum of c psi_neighbour) / diagonal, the Jacobi image of G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H.
double sweep(const View& v, const double* psi, double* other, double omega) {
  double largest = 0.0;
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
    const NodeRow c = v.node_rows[j];
    const double* here = psi + at;
    const double *south = j > 0 ? here - v.stride : here + v.stride, *north = j + 1 < v.rows ? here + v.stride : here - v.stride;
    const double *source = v.source + at, *inverse = v.inverse_diagonal + at;
    double* next = other + at;
    double change = 0.0;
#pragma omp simd reduction(max : change)
    for (Index i = 0; i < v.columns; ++i) {
      const double z = inverse[i] * (source[i] + c.side * (here[i - 1] + here[i + 1]) + c.south * south[i] + c.north * north[i]);
      const double step = z - here[i];
      change = larger(step < 0.0 ? -step : step, change);
      next[i] = next[i] + omega * (z - next[i]);
    }
    mirror(v, next);
    largest = larger(change, largest);
  }
  return largest;
}

EnergyDrop degrade(const View& v, const double* psi) {
  EnergyDrop sum{0.0, 0.0};
  double *released = scratch_row(v, 0), *elastic = scratch_row(v, 1);
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
    const double *row = psi + at, *stored = v.stored + at, *before = v.stored_before + at;
    double* g = v.g + at;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      const double now = law::degradation(row[i], v.eta);
      released[i] = (g[i] - now) * (0.5 * (before[i] + stored[i]));
      elastic[i] = now * stored[i];
      g[i] = now;
    }
    sum.released += ordered_sum(released, v.padded);
    sum.elastic += ordered_sum(elastic, v.padded);
  }
  return sum;
}

INLINE Stress degraded(double g, const Stress& s) { return {g * s.xx, g * s.zz, g * s.xz}; }

// What an element row gives to the force of its nodes.
struct ForceRows {
  double *sw_x, *se_x, *nw_x, *ne_x, *sw_z, *se_z, *nw_z, *ne_z;
};

INLINE void element_force(const ForceRows& f, Index i, const Stress& sw, const Stress& se, const Stress& nw, const Stress& ne, double per_x,
                          double per_z) {
  const double xx_south = per_x * (sw.xx + se.xx), xx_north = per_x * (nw.xx + ne.xx);
  const double zx_south = per_x * (sw.xz + se.xz), zx_north = per_x * (nw.xz + ne.xz);
  const double zz_west = per_z * (sw.zz + nw.zz), zz_east = per_z * (se.zz + ne.zz);
  const double xz_west = per_z * (sw.xz + nw.xz), xz_east = per_z * (se.xz + ne.xz);
  f.sw_x[i] = xx_south + xz_west;
  f.se_x[i] = xz_east - xx_south;
  f.nw_x[i] = xx_north - xz_west;
  f.ne_x[i] = -xx_north - xz_east;
  f.sw_z[i] = zx_south + zz_west;
  f.se_z[i] = zz_east - zx_south;
  f.nw_z[i] = zx_north - zz_west;
  f.ne_z[i] = -zx_north - zz_east;
}

INLINE void elastic_force_row(const View& v, int j, const ForceRows& f, const Stiffness& C) {
  const RowPair r = row_pair(v, j);
  const double *g0 = v.g + Index(j) * v.stride, *g1 = g0 + v.stride;
  const double per_x = v.corner_area / v.hx, per_z = v.corner_area / v.hz;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    element_force(f, i, degraded(g0[i], law::stress(C, e.sw)), degraded(g0[i + 1], law::stress(C, e.se)),
                  degraded(g1[i], law::stress(C, e.nw)), degraded(g1[i + 1], law::stress(C, e.ne)), per_x, per_z);
  }
}

INLINE Stress secant_stress(const law::Secant& secant, double s, const Strain& e) {
  return law::stress(law::reduced_stiffness(secant, s), e);
}

INLINE void secant_force_row(const View& v, int j, const ForceRows& f, const law::Secant& secant) {
  const RowPair r = row_pair(v, j);
  const Index at = Index(j) * v.stride;
  const double *S0 = v.reduction[0] + at, *S1 = v.reduction[1] + at, *S2 = v.reduction[2] + at, *S3 = v.reduction[3] + at;
  const double *g0 = v.g + at, *g1 = g0 + v.stride;
  const double per_x = v.corner_area / v.hx, per_z = v.corner_area / v.hz;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    element_force(f, i, degraded(g0[i], secant_stress(secant, S0[i], e.sw)), degraded(g0[i + 1], secant_stress(secant, S1[i], e.se)),
                  degraded(g1[i], secant_stress(secant, S2[i], e.nw)), degraded(g1[i + 1], secant_stress(secant, S3[i], e.ne)), per_x,
                  per_z);
  }
}

// The law is chosen once for a row.
INLINE void force_row(const View& v, int j, const ForceRows& f) {
  const ElementRow& row = v.element_rows[j];
  if (v.row_yields[j])
    secant_force_row(v, j, f, row.secant);
  else
    elastic_force_row(v, j, f, row.stiffness);
}

StressSum internal_force(const View& v) {
  StressSum sum{0.0, 0.0};
  const ForceRows f{scratch_row(v, 0), scratch_row(v, 1), scratch_row(v, 2), scratch_row(v, 3),
                    scratch_row(v, 4), scratch_row(v, 5), scratch_row(v, 6), scratch_row(v, 7)};
  double *xx = scratch_row(v, 8), *zz = scratch_row(v, 9);
  for (Index i = 0; i < v.padded; ++i) v.fx[i] = v.fz[i] = 0.0;
  for (int j = 0; j + 1 < v.rows; ++j) {
    force_row(v, j, f);
    for (double* row : {f.sw_x, f.se_x, f.nw_x, f.ne_x, f.sw_z, f.se_z, f.nw_z, f.ne_z}) clear_pad(v, row);
    double *fx0 = v.fx + Index(j) * v.stride, *fz0 = v.fz + Index(j) * v.stride, *fx1 = fx0 + v.stride, *fz1 = fz0 + v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      fx0[i] = fx0[i] + (f.sw_x[i] + f.se_x[i - 1]);
      fz0[i] = fz0[i] + (f.sw_z[i] + f.se_z[i - 1]);
      fx1[i] = f.nw_x[i] + f.ne_x[i - 1];
      fz1[i] = f.nw_z[i] + f.ne_z[i - 1];
      xx[i] = f.sw_x[i] + f.nw_x[i];  // the shears cancel: hx times this is the integral of sigma_xx over the element
      zz[i] = f.sw_z[i] + f.se_z[i];
    }
    sum.xx += v.hx * ordered_sum(xx, v.padded);
    sum.zz += v.hz * ordered_sum(zz, v.padded);
  }
  return sum;
}

double kinetic(const View& v, double half_dt) {
  double* energy = scratch_row(v, 0);
  double sum = 0.0;
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      const double x = v.vx[at + i] + half_dt * (v.fx[at + i] * v.inverse_mass_x[at + i]);
      const double z = v.vz[at + i] + half_dt * (v.fz[at + i] * v.inverse_mass_z[at + i]);
      energy[i] = 0.5 * v.mass[at + i] * (x * x + z * z);
    }
    sum += ordered_sum(energy, v.padded);
  }
  return sum;
}

SurfaceSum surface(const View& v, const double* psi) {
  SurfaceSum sum{0.0, 0.0, 0.0};
  double *square = scratch_row(v, 0), *slope = scratch_row(v, 1);
  for (int j = 0; j + 1 < v.rows; ++j) {
    const double *south = psi + Index(j) * v.stride, *north = south + v.stride;
    const double per_xx = 1.0 / (v.hx * v.hx), per_zz = 1.0 / (v.hz * v.hz);
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      square[i] = (south[i] * south[i] + south[i + 1] * south[i + 1]) + (north[i] * north[i] + north[i + 1] * north[i + 1]);
      const double s = south[i + 1] - south[i], n = north[i + 1] - north[i], w = north[i] - south[i], e = north[i + 1] - south[i + 1];
      slope[i] = 2.0 * (per_xx * (s * s + n * n) + per_zz * (w * w + e * e));
    }
    clear_pad(v, square);
    clear_pad(v, slope);
    const ElementRow& row = v.element_rows[j];
    const double gradient = v.corner_area * ordered_sum(slope, v.padded);
    sum.local += 0.5 * row.surface * v.corner_area * ordered_sum(square, v.padded);
    sum.gradient += 0.5 * row.surface_slope * gradient;
    sum.length += row.width * gradient;
  }
  return sum;
}

#define FRACFARM_TEXT_OF(name) #name
#define FRACFARM_TEXT(name) FRACFARM_TEXT_OF(name)

}  // namespace

extern const Kernels table;
const Kernels table{
    FRACFARM_TEXT(FRACFARM_ISA), move, update_history, set_diagonal, extrapolate, sweep, degrade, internal_force, kinetic, surface};

}  // namespace fracfarm::phasefield::FRACFARM_ISA
