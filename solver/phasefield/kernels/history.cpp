// H = max(H, drive), the energy that damage can release, and a row of the psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

// A pinned node's row becomes "psi = 1": with these two its Jacobi image is 1 to the last bit, whatever its neighbours are.
constexpr Real pinned_source = sizeof(Real) == 8 ? Real(0x1p200) : Real(0x1p100);
constexpr Real pinned_inverse = sizeof(Real) == 8 ? Real(0x1p-200) : Real(0x1p-100);

// The fields of a row, and what the psi equation makes of them.
struct Row {
  Real *sw, *se, *nw, *ne, *stored, *before, *source, *inverse;
  Real weight, threshold, diagonal;
};

INLINE Row row_of(const View& v, int j) {
  const Index at = row_at(v, j);
  const NodeRow& c = v.node_rows[j];
  return {v.history[0] + at, v.history[1] + at,       v.history[2] + at, v.history[3] + at, v.stored + at, v.stored_before + at,
          v.source + at,     v.inverse_diagonal + at, c.weight,          c.threshold,       c.diagonal};
}

// How much nearer the step before is than the time a tile was last worked on, as a share of the time between: energies in between lie on a
// line.
INLINE Real nearer(const View& v, Index flag) { return v.moves[flag] ? Real(0) : Real(1) - Real(1) / Real(rest_steps); }

INLINE void commit(const Row& row, Index i, Real nearer, Real stored, Real sw, Real se, Real nw, Real ne) {
  row.before[i] = row.stored[i] + nearer * (stored - row.stored[i]);
  row.stored[i] = stored;
  const Real a = larger(sw, row.sw[i]), b = larger(se, row.se[i]), c = larger(nw, row.nw[i]), d = larger(ne, row.ne[i]);
  row.sw[i] = a, row.se[i] = b, row.nw[i] = c, row.ne[i] = d;
  const Real sum = row.weight * ((a + b) + (c + d));
  row.source[i] = sum - row.threshold;
  row.inverse[i] = Real(1) / (row.diagonal + sum);
}

template <bool clips>
INLINE Real driving(Real difference) {
  return clips ? law::positive(difference) : difference;
}

using Differenced = phasefield::Differenced<Real>;

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
  const Differenced n = v.element_rows[j + 1].energy, s = v.element_rows[j].energy;
  const Real ratio = Real(v.hz / v.hx);
  over_tiles(
      v, j, [&](Index tile, Index flag) __attribute__((always_inline)) {
        const Real share = nearer(v, flag);
        along_tile(
            tile, TILE_BODY {
              Real stored;
              const Drives drives = elastic_drives<clips>(n, s, differences(u, i, ratio), stored);
              commit(row, i, share, stored, drives.sw, drives.se, drives.nw, drives.ne);
            });
      });
}

using Yielding = phasefield::Yielding<Real>;

INLINE Real yield_form(const Yielding& law, Real x, Real z, Real shear) {
  return (law.normal_x * (x * x) + law.normal_z * (z * z)) + (law.shear * (shear * shear) - law.cross * (x * z));
}

// What yielding takes from a quadrant.
template <bool clips>
INLINE void yield(const Yielding& law, Real x, Real z, Real shear, Real& drive, Real& stored, Real& reduction) {
  const Real p = larger(yield_form(law, x, z, shear), Real(1)), r = Real(1) / std::sqrt(p), past = p * r - Real(1), lost = Real(1) - r;
  drive -= law.drive * lost * (clips ? yield_form(law, driving<clips>(x), driving<clips>(z), shear) : p);
  stored -= law.energy * (past * past);
  reduction = Real(1) - law.soft * lost;
}

// Tiles that will yield before long do not rest: what they took up elastically past sigma_y the potential would not give back. Of p.
constexpr Real near_yield = Real(0.5);

// One tile on its way through the secant law.
struct alignas(64) Tile {
  Real sw[lanes], se[lanes], nw[lanes], ne[lanes], stored[lanes], most[lanes];
};

// Tiles that may yield: elastic first, and those that yield once more. Of nodes that a crack holds nothing but the residual stiffness is
// left, and an open crack's strain is no strain of the metal: they do not make a tile yield.
template <bool clips>
INLINE void plastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Around u = around(v, j);
  const Differenced n = v.element_rows[j + 1].energy, s = v.element_rows[j].energy;
  const Yielding above = v.element_rows[j + 1].yielding, below = v.element_rows[j].yielding;
  const Real ratio = Real(v.hz / v.hx);
  const Index at = row_at(v, j);
  const Real* whole = v.whole_nodes + at;
  Real *r0 = v.reduction[0] + at, *r1 = v.reduction[1] + at, *r2 = v.reduction[2] + at, *r3 = v.reduction[3] + at;
  Tile t;
  over_tiles(
      v, j, [&](Index tile, Index flag) __attribute__((always_inline)) {
        along_tile(
            tile, TILE_BODY {
              const Differences d = differences(u, i, ratio);
              const Drives drives = elastic_drives<clips>(n, s, d, t.stored[l]);
              t.sw[l] = drives.sw, t.se[l] = drives.se, t.nw[l] = drives.nw, t.ne[l] = drives.ne;
              const Real p_south = larger(yield_form(below, d.xw, d.zs, d.sw), yield_form(below, d.xe, d.zs, d.se));
              t.most[l] = whole[i] * larger(p_south, larger(yield_form(above, d.xw, d.zn, d.nw), yield_form(above, d.xe, d.zn, d.ne)));
            });
        const Real most = largest(t.most);
        const bool yields = !v.tests_yield || most > Real(1);
        if (yields)
          along_tile(
              tile, TILE_BODY {
                const Differences d = differences(u, i, ratio);
                yield<clips>(below, d.xw, d.zs, d.sw, t.sw[l], t.stored[l], r0[i]);
                yield<clips>(below, d.xe, d.zs, d.se, t.se[l], t.stored[l], r1[i]);
                yield<clips>(above, d.xw, d.zn, d.nw, t.nw[l], t.stored[l], r2[i]);
                yield<clips>(above, d.xe, d.zn, d.ne, t.ne[l], t.stored[l], r3[i]);
              });
        else if (v.yields[flag] == does_yield)
          along_tile(
              tile, TILE_BODY { r0[i] = r1[i] = r2[i] = r3[i] = Real(1); });
        v.yields[flag] = yields ? does_yield : most > near_yield ? nearly_yields : 0;
        const Real share = nearer(v, flag);
        along_tile(
            tile, TILE_BODY { commit(row, i, share, t.stored[l], t.sw[l], t.se[l], t.nw[l], t.ne[l]); });
      });
}

template <bool clips>
INLINE void driving_history(const View& v, int j) {
  const bool may_yield = v.element_rows[j + 1].plastic || v.element_rows[j].plastic;
  if (may_yield)
    plastic_history<clips>(v, j);
  else
    elastic_history<clips>(v, j);
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
        const Real stored = (s.degraded_energy(e.sw) + s.degraded_energy(e.se)) + (n.degraded_energy(e.nw) + n.degraded_energy(e.ne));
        kept[i] = weight[i] * ((s.kept_energy(e.sw) + s.kept_energy(e.se)) + (n.kept_energy(e.nw) + n.kept_energy(e.ne)));
        commit(row, i, Real(0), stored, s.drive(e.sw), s.drive(e.se), n.drive(e.nw), n.drive(e.ne));
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

// The potential of the secant law is the elastic one where p <= 1.
double elastic_energy(const View& v, int j) {
  const Around u = around(v, j);
  const Differenced n = v.element_rows[j + 1].energy, s = v.element_rows[j].energy;
  const Yielding above = v.element_rows[j + 1].yielding, below = v.element_rows[j].yielding;
  const Real ratio = Real(v.hz / v.hx), *g = v.degradation + row_at(v, j), *weight = v.column_weight;
  const auto lost = [](const Yielding& law, Real x, Real z, Real shear) __attribute__((always_inline)) {
    const Real past = std::sqrt(larger(yield_form(law, x, z, shear), Real(1))) - Real(1);
    return law.energy * (past * past);
  };
  Partial energy;
  along_tiles(
      v.padded, TILE_BODY {
        const Differences d = differences(u, i, ratio);
        Real stored;
        elastic_drives<false>(n, s, d, stored);
        stored -= (lost(below, d.xw, d.zs, d.sw) + lost(below, d.xe, d.zs, d.se)) +
                  (lost(above, d.xw, d.zn, d.nw) + lost(above, d.xe, d.zn, d.ne));
        energy.at[l] += weight[i] * g[i] * stored;
      });
  return v.corner_area * ordered_sum(energy);
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
