// H = max(H, drive), the energy that damage can release, and a row of the psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

// A pinned node's row becomes "psi = 1": with these two its Jacobi image is 1 to the last bit, whatever its neighbours are.
constexpr Real pinned_source = sizeof(Real) == 8 ? Real(0x1p200) : Real(0x1p100);
constexpr Real pinned_inverse = sizeof(Real) == 8 ? Real(0x1p-200) : Real(0x1p-100);

// The four fields of a row, and what the psi equation makes of them.
struct Row {
  Real *sw, *se, *nw, *ne, *stored, *source, *inverse;
  Real weight, threshold, diagonal;
};

INLINE Row row_of(const View& v, int j) {
  const Index at = row_at(v, j);
  const NodeRow& c = v.node_rows[j];
  return {v.history[0] + at, v.history[1] + at,       v.history[2] + at, v.history[3] + at, v.stored + at,
          v.source + at,     v.inverse_diagonal + at, c.weight,          c.threshold,       c.diagonal};
}

INLINE void commit(const Row& row, Index i, Real sw, Real se, Real nw, Real ne) {
  const Real a = larger(sw, row.sw[i]), b = larger(se, row.se[i]), c = larger(nw, row.nw[i]), d = larger(ne, row.ne[i]);
  row.sw[i] = a, row.se[i] = b, row.nw[i] = c, row.ne[i] = d;
  const Real sum = row.weight * ((a + b) + (c + d));
  row.source[i] = sum - row.threshold;
  row.inverse[i] = Real(1) / (row.diagonal + sum);
}

// Half the stiffness per squared spacing, for differences of displacements. Shear is (z_e hz / hx + x_n)^2 c55.
struct Differenced {
  Real c11, c33, c13, c55;
};

INLINE Differenced differenced(const View& v, const ElementRow& row) {
  const Real x = Real(1.0 / v.hx), z = Real(1.0 / v.hz), half = Real(0.5);
  const Stiffness& C = row.stiffness;
  return {half * C.C11 * x * x, half * C.C33 * z * z, C.C13 * x * z, half * C.C55 * z * z};
}

template <bool clips>
INLINE Real driving(Real difference) {
  return clips ? law::positive(difference) : difference;
}

// Linear elastic rows. The seed's drive (clipped normal strains, whole shear) or the whole energy, both from eight differences a node.
template <bool clips>
INLINE void elastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const Differenced n = differenced(v, v.element_rows[j + 1]), s = differenced(v, v.element_rows[j]);
  const Real c11 = n.c11 + s.c11, ratio = Real(v.hz / v.hx);
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Real xw = u.x[i] - u.x[i - 1], xe = u.x[i + 1] - u.x[i], xs = u.x[i] - u.x_south[i], xn = u.x_north[i] - u.x[i];
    const Real zs = u.z[i] - u.z_south[i], zn = u.z_north[i] - u.z[i];
    const Real zw = ratio * (u.z[i] - u.z[i - 1]), ze = ratio * (u.z[i + 1] - u.z[i]);
    const Real gsw = zw + xs, gse = ze + xs, gnw = zw + xn, gne = ze + xn;
    const Real shear_sw = s.c55 * (gsw * gsw), shear_se = s.c55 * (gse * gse);
    const Real shear_nw = n.c55 * (gnw * gnw), shear_ne = n.c55 * (gne * gne);
    row.stored[i] = (c11 * (xw * xw + xe * xe) + Real(2) * (n.c33 * (zn * zn) + s.c33 * (zs * zs))) +
                    ((xw + xe) * (n.c13 * zn + s.c13 * zs) + ((shear_sw + shear_se) + (shear_nw + shear_ne)));
    const Real dw = driving<clips>(xw), de = driving<clips>(xe), ds = driving<clips>(zs), dn = driving<clips>(zn);
    const Real square_s = s.c33 * (ds * ds), square_n = n.c33 * (dn * dn), cross_s = s.c13 * ds, cross_n = n.c13 * dn;
    commit(row, i, dw * (s.c11 * dw + cross_s) + (square_s + shear_sw), de * (s.c11 * de + cross_s) + (square_s + shear_se),
           dw * (n.c11 * dw + cross_n) + (square_n + shear_nw), de * (n.c11 * de + cross_n) + (square_n + shear_ne));
  }
}

// Rows where the secant law yields: drive and potential with the reduced moduli, whose factor is kept for the force. Past yield the
// potential is the elastic energy less (1 - h) (q - sigma_y)^2 / 6 mu, see law::stored_energy.
template <class Split>
INLINE Real secant_quadrant(const SecantRow& row, const Strain& e, Real& drive, Real& reduction) {
  const Real q = std::sqrt(law::von_mises_squared(row.law, e));
  const Real past = larger(q - row.law.yield, Real(0));
  reduction = law::reduction(row.law, q);
  drive = Split{reduced(row, reduction)}.drive(e);
  return law::strain_energy(row.elastic, e) - row.excess * (past * past);
}

template <class Split>
INLINE void secant_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const SecantRow n = secant_row(v.element_rows[j + 1]), s = secant_row(v.element_rows[j]);
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz);
  const Index at = row_at(v, j);
  Real *r0 = v.reduction[0] + at, *r1 = v.reduction[1] + at, *r2 = v.reduction[2] + at, *r3 = v.reduction[3] + at;
  along_row(
      v.padded, ROW_BODY {
        const Quadrants e = strains(u, i, per_hx, per_hz);
        Real sw, se, nw, ne;
        const Real w_sw = secant_quadrant<Split>(s, e.sw, sw, r0[i]), w_se = secant_quadrant<Split>(s, e.se, se, r1[i]);
        const Real w_nw = secant_quadrant<Split>(n, e.nw, nw, r2[i]), w_ne = secant_quadrant<Split>(n, e.ne, ne, r3[i]);
        row.stored[i] = (w_sw + w_se) + (w_nw + w_ne);
        commit(row, i, sw, se, nw, ne);
      });
}

// Of nodes that a crack holds nothing but the residual stiffness is left, and an open crack's strain is no strain of the metal: they do not
// count.
INLINE bool yields(const View& v, int j) {
  const ElementRow &above = v.element_rows[j + 1], &below = v.element_rows[j];
  if (!above.plastic && !below.plastic) return false;
  if (!v.tests_yield) return true;
  const Around u = around(v, j);
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz);
  const Secant n = above.secant, s = below.secant;
  const Real* whole = v.whole + row_at(v, j);
  Real north = Real(0), south = Real(0);
#pragma omp simd reduction(max : north, south)
  for (Index i = 0; i < v.columns; ++i) {
    const Quadrants e = strains(u, i, per_hx, per_hz);
    north = larger(whole[i] * larger(law::von_mises_squared(n, e.nw), law::von_mises_squared(n, e.ne)), north);
    south = larger(whole[i] * larger(law::von_mises_squared(s, e.sw), law::von_mises_squared(s, e.se)), south);
  }
  return (above.plastic && north > n.yield * n.yield) || (below.plastic && south > s.yield * s.yield);
}

// Splits that keep a part of the energy: its sum over the row, J/m.
template <class Law>
INLINE double split_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const Law n = LawOf<Law>::make(v.element_rows[j + 1]), s = LawOf<Law>::make(v.element_rows[j]);
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz);
  Real* kept = scratch_row(v, first_free_row);
  const Real* weight = v.column_weight;
  along_row(
      v.padded, ROW_BODY {
        const Quadrants e = strains(u, i, per_hx, per_hz);
        row.stored[i] = (s.degraded_energy(e.sw) + s.degraded_energy(e.se)) + (n.degraded_energy(e.nw) + n.degraded_energy(e.ne));
        kept[i] = weight[i] * ((s.kept_energy(e.sw) + s.kept_energy(e.se)) + (n.kept_energy(e.nw) + n.kept_energy(e.ne)));
        commit(row, i, s.drive(e.sw), s.drive(e.se), n.drive(e.nw), n.drive(e.ne));
      });
  return v.corner_area * ordered_sum(kept, v.padded);
}

INLINE double history_row(const View& v, int j) {
  switch (v.law) {
    case RowLaw::seed:
      if ((v.row_yields[j] = yields(v, j)))
        secant_history<law::SeedSplit<Real>>(v, j);
      else
        elastic_history<true>(v, j);
      return 0.0;
    case RowLaw::none:
      if ((v.row_yields[j] = yields(v, j)))
        secant_history<law::NoSplit<Real>>(v, j);
      else
        elastic_history<false>(v, j);
      return 0.0;
    case RowLaw::spectral:
      return split_history<law::SpectralSplit<Real>>(v, j);
    case RowLaw::star_convex:
      return split_history<law::StarConvexSplit<Real>>(v, j);
  }
  return 0.0;
}

}  // namespace

double history(const View& v, int j) {
  const double kept = history_row(v, j);
  Real *source = v.source + row_at(v, j), *inverse = v.inverse_diagonal + row_at(v, j);
  for (int k = v.pin_begin[j]; k < v.pin_begin[j + 1]; ++k) source[v.pins[k]] = pinned_source, inverse[v.pins[k]] = pinned_inverse;
  return kept;
}

// source > bound (m + S), where m + S is the diagonal without the neighbours; the equation of a pinned node reads 1 = 1.
bool damages(const View& v, int j, Real bound) {
  const NodeRow& c = v.node_rows[j];
  const Real *source = v.source + row_at(v, j), *inverse = v.inverse_diagonal + row_at(v, j);
  const Real neighbours = Real(2) * c.side + c.south + c.north;
  bool found = false;
  for (Index i = 0; i < v.columns; ++i) {
    const Real share = source[i] * inverse[i];
    found = found || (share != Real(1) && !(share <= bound * (Real(1) - neighbours * inverse[i])));
  }
  return found;
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
