// H = max(H, drive), the energy that damage can release, and a row of the psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H.
#include "solver/phasefield/kernels/quadrants.hpp"

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

INLINE void set_equation(const Row& row, Index i, Real sw, Real se, Real nw, Real ne) {
  const Real sum = row.weight * ((sw + se) + (nw + ne));
  row.source[i] = sum - row.threshold;
  row.inverse[i] = Real(1) / (row.diagonal + sum);
}

INLINE void pin(const View& v, int j) {
  Real *source = v.source + row_at(v, j), *inverse = v.inverse_diagonal + row_at(v, j);
  for (int k = v.pin_begin[j]; k < v.pin_begin[j + 1]; ++k) source[v.pins[k]] = pinned_source, inverse[v.pins[k]] = pinned_inverse;
}

INLINE void commit(const Row& row, Index i, Real nearer, Real stored, Real sw, Real se, Real nw, Real ne) {
  row.before[i] = row.stored[i] + nearer * (stored - row.stored[i]);
  row.stored[i] = stored;
  const Real a = larger(sw, row.sw[i]), b = larger(se, row.se[i]), c = larger(nw, row.nw[i]), d = larger(ne, row.ne[i]);
  row.sw[i] = a, row.se[i] = b, row.nw[i] = c, row.ne[i] = d;
  set_equation(row, i, a, b, c, d);
}

// The same for nodes as wide as an instruction; where no H rises the equation stays.
INLINE void commit(const Row& row, Index i, Real nearer, Wide stored, Wide sw, Wide se, Wide nw, Wide ne) {
  const Wide last = load(row.stored + i);
  store(row.before + i, last + nearer * (stored - last));
  store(row.stored + i, stored);
  const Wide h_sw = load(row.sw + i), h_se = load(row.se + i), h_nw = load(row.nw + i), h_ne = load(row.ne + i);
  if (!any_above(larger(larger(sw - h_sw, se - h_se), larger(nw - h_nw, ne - h_ne)), Real(0))) return;
  const Wide a = larger(sw, h_sw), b = larger(se, h_se), c = larger(nw, h_nw), d = larger(ne, h_ne);
  store(row.sw + i, a), store(row.se + i, b), store(row.nw + i, c), store(row.ne + i, d);
  const Wide sum = row.weight * ((a + b) + (c + d));
  store(row.source + i, sum - row.threshold);
  store(row.inverse + i, Real(1) / (row.diagonal + sum));
}

template <bool clips>
INLINE Wide driving(Wide difference) {
  return clips ? larger(difference, Wide{}) : difference;
}

INLINE Wide elastic_energy(const Between& row, const Differences& d) {
  const Differenced &n = row.n, &s = row.s;
  const Wide shear = s.c55 * (d.sw * d.sw + d.se * d.se) + n.c55 * (d.nw * d.nw + d.ne * d.ne);
  return ((n.c11 + s.c11) * (d.xw * d.xw + d.xe * d.xe) + Real(2) * (n.c33 * (d.zn * d.zn) + s.c33 * (d.zs * d.zs))) +
         ((d.xw + d.xe) * (n.c13 * d.zn + s.c13 * d.zs) + shear);
}

// The seed's drive (clipped normal strains, whole shear) or the whole energy.
template <bool clips>
INLINE Quarters elastic_drives(const Between& row, const Differences& d) {
  const Differenced &n = row.n, &s = row.s;
  const Wide xw = driving<clips>(d.xw), xe = driving<clips>(d.xe), zs = driving<clips>(d.zs), zn = driving<clips>(d.zn);
  const Wide square_s = s.c33 * (zs * zs), square_n = n.c33 * (zn * zn), cross_s = s.c13 * zs, cross_n = n.c13 * zn;
  return {
      xw * (s.c11 * xw + cross_s) + (square_s + s.c55 * (d.sw * d.sw)), xe * (s.c11 * xe + cross_s) + (square_s + s.c55 * (d.se * d.se)),
      xw * (n.c11 * xw + cross_n) + (square_n + n.c55 * (d.nw * d.nw)), xe * (n.c11 * xe + cross_n) + (square_n + n.c55 * (d.ne * d.ne))};
}

// What yielding takes from a quadrant; nothing where p <= 1.
template <bool clips>
INLINE void yield(const Yielding& law, Wide p, Wide x, Wide z, Wide shear, Wide& drive, Wide& stored) {
  const Wide beyond = larger(p, all(Real(1))), r = Real(1) / root(beyond), past = beyond * r - Real(1);
  drive -= law.drive * (Real(1) - r) * (clips ? yield_form(law, driving<clips>(x), driving<clips>(z), shear) : beyond);
  stored -= law.energy * (past * past);
}

template <bool clips>
INLINE void elastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Between at = between(v, j);
  over_tiles(
      v, j, [&](Index tile, Index flag) __attribute__((always_inline)) {
        const Real share = nearer(v, flag);
        for (Index i = tile; i < tile + lanes; i += width) {
          const Differences d = differences(at, i);
          const Quarters drives = elastic_drives<clips>(at, d);
          commit(row, i, share, elastic_energy(at, d), drives.sw, drives.se, drives.nw, drives.ne);
        }
      });
}

// A tile that may yield: elastic first, and once more where it does.
template <bool clips>
INLINE void plastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Between at = between(v, j);
  const Real* whole = v.whole_nodes + row_at(v, j);
  over_tiles(
      v, j, [&](Index tile, Index flag) __attribute__((always_inline)) {
        const unsigned char yields = may_yield(v, at, whole, tile) ? yielding_of(v, at, whole, tile) : 0;
        const Real share = nearer(v, flag);
        for (Index i = tile; i < tile + lanes; i += width) {
          const Differences d = differences(at, i);
          Wide stored = elastic_energy(at, d);
          Quarters drives = elastic_drives<clips>(at, d);
          if (yields == does_yield) {
            const Quarters p = yield_forms(at, d);
            yield<clips>(at.below, p.sw, d.xw, d.zs, d.sw, drives.sw, stored);
            yield<clips>(at.below, p.se, d.xe, d.zs, d.se, drives.se, stored);
            yield<clips>(at.above, p.nw, d.xw, d.zn, d.nw, drives.nw, stored);
            yield<clips>(at.above, p.ne, d.xe, d.zn, d.ne, drives.ne, stored);
          }
          commit(row, i, share, stored, drives.sw, drives.se, drives.nw, drives.ne);
        }
        v.yields[flag] = yields;
      });
}

template <bool clips>
INLINE void driving_history(const View& v, int j) {
  const bool plastic = v.element_rows[j + 1].plastic || v.element_rows[j].plastic;
  if (plastic)
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
  pin(v, j);
  return kept;
}

void equation(const View& v, int j) {
  const Row row = row_of(v, j);
  along_row(
      v.padded, ROW_BODY { set_equation(row, i, row.sw[i], row.se[i], row.nw[i], row.ne[i]); });
  pin(v, j);
}

namespace {

// (q / sigma_y - 1)^2 past yield.
INLINE Wide square_past(Wide p) {
  const Wide past = root(larger(p, all(Real(1)))) - Real(1);
  return past * past;
}

}  // namespace

// The potential of the secant law is the elastic one where p <= 1.
double elastic_energy(const View& v, int j) {
  const Between at = between(v, j);
  const Real *g = v.degradation + row_at(v, j), *weight = v.column_weight;
  const bool plastic = v.element_rows[j + 1].plastic || v.element_rows[j].plastic;
  Partial energy;
  for (Index part = 0; part < lanes; part += width) {
    Wide sum{};
    for (Index i = part; i < v.padded; i += lanes) {
      const Differences d = differences(at, i);
      Wide stored = elastic_energy(at, d);
      if (plastic) {
        const Quarters p = yield_forms(at, d);
        stored -= at.below.energy * (square_past(p.sw) + square_past(p.se)) + at.above.energy * (square_past(p.nw) + square_past(p.ne));
      }
      sum += load(weight + i) * load(g + i) * stored;
    }
    store(energy.at + part, sum);
  }
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
