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

// Differences of the displacements around a node, ratio = hz / hx: shear strains of the quadrants in units of 1 / hz.
struct Differences {
  Real xw, xe, zs, zn;
  Real sw, se, nw, ne;  // shear
};

INLINE Differences differences(const Around& u, Index i, Real ratio) {
  const Real xs = u.x[i] - u.x_south[i], xn = u.x_north[i] - u.x[i];
  const Real zw = ratio * (u.z[i] - u.z[i - 1]), ze = ratio * (u.z[i + 1] - u.z[i]);
  return {u.x[i] - u.x[i - 1], u.x[i + 1] - u.x[i], u.z[i] - u.z_south[i], u.z_north[i] - u.z[i], zw + xs, ze + xs, zw + xn, ze + xn};
}

struct Drives {
  Real sw, se, nw, ne;
};

// Linear elastic quadrants. The seed's drive (clipped normal strains, whole shear) or the whole energy, and the stored energy.
template <bool clips>
INLINE Drives elastic_drives(const Differenced& n, const Differenced& s, const Differences& d, Real& stored) {
  const Real shear_sw = s.c55 * (d.sw * d.sw), shear_se = s.c55 * (d.se * d.se);
  const Real shear_nw = n.c55 * (d.nw * d.nw), shear_ne = n.c55 * (d.ne * d.ne);
  stored = ((n.c11 + s.c11) * (d.xw * d.xw + d.xe * d.xe) + Real(2) * (n.c33 * (d.zn * d.zn) + s.c33 * (d.zs * d.zs))) +
           ((d.xw + d.xe) * (n.c13 * d.zn + s.c13 * d.zs) + ((shear_sw + shear_se) + (shear_nw + shear_ne)));
  const Real xw = driving<clips>(d.xw), xe = driving<clips>(d.xe), zs = driving<clips>(d.zs), zn = driving<clips>(d.zn);
  const Real square_s = s.c33 * (zs * zs), square_n = n.c33 * (zn * zn), cross_s = s.c13 * zs, cross_n = n.c13 * zn;
  return {xw * (s.c11 * xw + cross_s) + (square_s + shear_sw), xe * (s.c11 * xe + cross_s) + (square_s + shear_se),
          xw * (n.c11 * xw + cross_n) + (square_n + shear_nw), xe * (n.c11 * xe + cross_n) + (square_n + shear_ne)};
}

template <bool clips>
INLINE void elastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const Differenced n = differenced(v, v.element_rows[j + 1]), s = differenced(v, v.element_rows[j]);
  const Real ratio = Real(v.hz / v.hx);
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Drives drives = elastic_drives<clips>(n, s, differences(u, i, ratio), row.stored[i]);
    commit(row, i, drives.sw, drives.se, drives.nw, drives.ne);
  }
}

// The secant law of a row of elements in differences of displacements. With p = (q / sigma_y)^2, a quadratic form of the strain, and
// r = sigma_y / q past yield, else 1, yielding takes the share (1 - h) (1 - r) of mu: the drive loses `drive` (1 - r) p of the strain that
// drives, and the potential `energy` (q / sigma_y - 1)^2, see law::stored_energy. All are 0 where the row does not yield at all.
struct Yielding {
  Real normal_x, normal_z, cross, shear;  // of p
  Real soft;                              // 1 - h
  Real drive, energy;                     // J/m^3

  INLINE Real p(Real x, Real z, Real shear_difference) const {
    return (normal_x * (x * x) + normal_z * (z * z)) + (shear * (shear_difference * shear_difference) - cross * (x * z));
  }
};

INLINE Yielding yielding(const View& v, const ElementRow& row) {
  if (!row.plastic) return {};
  const double mu = row.secant.mu, yield = row.secant.yield, soft = 1.0 - double(row.secant.hardening_share);
  const double unit = 6.0 * mu * mu / (yield * yield), x = 1.0 / v.hx, z = 1.0 / v.hz;
  return {Real(2.0 / 3.0 * unit * x * x),
          Real(2.0 / 3.0 * unit * z * z),
          Real(2.0 / 3.0 * unit * x * z),
          Real(0.5 * unit * z * z),
          Real(soft),
          Real(soft * mu / unit),
          Real(soft * yield * yield / (6.0 * mu))};
}

// What yielding takes from a quadrant.
template <bool clips>
INLINE void yield(const Yielding& law, Real x, Real z, Real shear, Real& drive, Real& stored, Real& reduction) {
  const Real p = larger(law.p(x, z, shear), Real(1)), r = Real(1) / std::sqrt(p), past = p * r - Real(1), lost = Real(1) - r;
  drive -= law.drive * lost * (clips ? law.p(driving<clips>(x), driving<clips>(z), shear) : p);
  stored -= law.energy * (past * past);
  reduction = Real(1) - law.soft * lost;
}

// Rows that may yield: elastic first, and the tiles that yield once more. Of nodes that a crack holds nothing but the residual stiffness is
// left, and an open crack's strain is no strain of the metal: they do not make a tile yield. Returns whether any does.
template <bool clips>
INLINE bool plastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const Differenced n = differenced(v, v.element_rows[j + 1]), s = differenced(v, v.element_rows[j]);
  const Yielding above = yielding(v, v.element_rows[j + 1]), below = yielding(v, v.element_rows[j]);
  const Real ratio = Real(v.hz / v.hx);
  const Index at = row_at(v, j);
  const Real* whole = v.whole + at;
  Real *sw = scratch_row(v, first_free_row), *se = scratch_row(v, first_free_row + 1), *nw = scratch_row(v, first_free_row + 2),
       *ne = scratch_row(v, first_free_row + 3), *most = scratch_row(v, first_free_row + 4);
  Real row_most = Real(0);
#pragma omp simd reduction(max : row_most)
  for (Index i = 0; i < v.padded; ++i) {
    const Differences d = differences(u, i, ratio);
    const Drives drives = elastic_drives<clips>(n, s, d, row.stored[i]);
    sw[i] = drives.sw, se[i] = drives.se, nw[i] = drives.nw, ne[i] = drives.ne;
    const Real p_south = larger(below.p(d.xw, d.zs, d.sw), below.p(d.xe, d.zs, d.se));
    const Real p = whole[i] * larger(p_south, larger(above.p(d.xw, d.zn, d.nw), above.p(d.xe, d.zn, d.ne)));
    most[i] = p;
    row_most = larger(p, row_most);
  }
  const bool yields = !v.tests_yield || row_most > Real(1);
  Real *r0 = v.reduction[0] + at, *r1 = v.reduction[1] + at, *r2 = v.reduction[2] + at, *r3 = v.reduction[3] + at;
  for (Index tile = 0; yields && tile < v.padded; tile += lanes) {
    if (!v.tests_yield || largest(most + tile) > Real(1))
      along_tile(
          tile, TILE_BODY {
            const Differences d = differences(u, i, ratio);
            yield<clips>(below, d.xw, d.zs, d.sw, sw[i], row.stored[i], r0[i]);
            yield<clips>(below, d.xe, d.zs, d.se, se[i], row.stored[i], r1[i]);
            yield<clips>(above, d.xw, d.zn, d.nw, nw[i], row.stored[i], r2[i]);
            yield<clips>(above, d.xe, d.zn, d.ne, ne[i], row.stored[i], r3[i]);
          });
    else
      along_tile(
          tile, TILE_BODY { r0[i] = r1[i] = r2[i] = r3[i] = Real(1); });
  }
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) commit(row, i, sw[i], se[i], nw[i], ne[i]);
  return yields;
}

template <bool clips>
INLINE void driving_history(const View& v, int j) {
  const bool may_yield = v.element_rows[j + 1].plastic || v.element_rows[j].plastic;
  v.row_yields[j] = may_yield && plastic_history<clips>(v, j);
  if (!may_yield) elastic_history<clips>(v, j);
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
      driving_history<true>(v, j);
      return 0.0;
    case RowLaw::none:
      driving_history<false>(v, j);
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
