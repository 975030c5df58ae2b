// H = max(H, Phi+) at the corners of each element, the stored energy around each node, and the right side of the psi equation.
#include "solver/law/splits.hpp"
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_ISA {
namespace {

// Largest q^2 of an element row.
INLINE double largest_von_mises_squared(const View& v, const law::Secant<double>& secant, const RowPair& r) {
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
    H0[i] = larger(law::SeedSplit<double>{C}.drive(e.sw), H0[i]);
    H1[i] = larger(law::SeedSplit<double>{C}.drive(e.se), H1[i]);
    H2[i] = larger(law::SeedSplit<double>{C}.drive(e.nw), H2[i]);
    H3[i] = larger(law::SeedSplit<double>{C}.drive(e.ne), H3[i]);
    W0[i] = law::strain_energy(C, e.sw);
    W1[i] = law::strain_energy(C, e.se);
    W2[i] = law::strain_energy(C, e.nw);
    W3[i] = law::strain_energy(C, e.ne);
  }
}

INLINE void secant_corner(const law::Secant<double>& secant, const Strain& e, double& H, double& W, double& s) {
  const double q = __builtin_sqrt(law::von_mises_squared(secant, e));
  s = law::reduction(secant, q);
  H = larger(law::SeedSplit<double>{law::reduced_stiffness(secant, s)}.drive(e), H);
  W = law::stored_energy(secant, e, q);
}

INLINE void secant_history_row(const View& v, const law::Secant<double>& secant, const RowPair& r, double* const H[4], double* const W[4],
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

}  // namespace

void update_history(const View& v) {
  for (Index i = 0; i < v.padded; ++i) v.stored[i] = 0.0;
  for (int j = 0; j + 1 < v.rows; ++j) history_row(v, j);
  for (int j = 0; j < v.rows; ++j) source_row(v, j);
}

}  // namespace fracfarm::phasefield::FRACFARM_ISA
