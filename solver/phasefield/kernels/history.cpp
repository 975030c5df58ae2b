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

// The same for nodes as wide as an instruction.
INLINE void commit(const Row& row, Index i, Real nearer, Wide stored, Wide sw, Wide se, Wide nw, Wide ne) {
  const Wide last = load(row.stored + i);
  store(row.before + i, last + nearer * (stored - last));
  store(row.stored + i, stored);
  const Wide a = larger(sw, load(row.sw + i)), b = larger(se, load(row.se + i));
  const Wide c = larger(nw, load(row.nw + i)), d = larger(ne, load(row.ne + i));
  store(row.sw + i, a), store(row.se + i, b), store(row.nw + i, c), store(row.ne + i, d);
  const Wide sum = row.weight * ((a + b) + (c + d));
  store(row.source + i, sum - row.threshold);
  store(row.inverse + i, Real(1) / (row.diagonal + sum));
}

using Differenced = phasefield::Differenced<Real>;
using Yielding = phasefield::Yielding<Real>;

// Two rows of elements with the nodes between them.
struct Between {
  Around u;
  Differenced n, s;
  Yielding above, below;
  Real ratio;  // hz / hx
};

INLINE Between between(const View& v, int j) {
  const ElementRow &n = v.element_rows[j + 1], &s = v.element_rows[j];
  return {around(v, j), n.energy, s.energy, n.yielding, s.yielding, Real(v.hz / v.hx)};
}

// Differences of the displacements around nodes: shear strains of the quadrants in units of 1 / hz.
struct Differences {
  Wide xw, xe, zs, zn;
  Wide sw, se, nw, ne;  // shear
};

INLINE Differences differences(const Between& row, Index i) {
  const Around& u = row.u;
  const Wide x = load(u.x + i), z = load(u.z + i), xs = x - load(u.x_south + i), xn = load(u.x_north + i) - x;
  const Wide zw = row.ratio * (z - load(u.z + i - 1)), ze = row.ratio * (load(u.z + i + 1) - z);
  return {x - load(u.x + i - 1), load(u.x + i + 1) - x, z - load(u.z_south + i), load(u.z_north + i) - z, zw + xs, ze + xs, zw + xn, ze + xn};
}

struct Quarters {
  Wide sw, se, nw, ne;
};

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
  return {xw * (s.c11 * xw + cross_s) + (square_s + s.c55 * (d.sw * d.sw)), xe * (s.c11 * xe + cross_s) + (square_s + s.c55 * (d.se * d.se)),
          xw * (n.c11 * xw + cross_n) + (square_n + n.c55 * (d.nw * d.nw)), xe * (n.c11 * xe + cross_n) + (square_n + n.c55 * (d.ne * d.ne))};
}

INLINE Wide yield_form(const Yielding& law, Wide x, Wide z, Wide shear) {
  return (law.normal_x * (x * x) + law.normal_z * (z * z)) + (law.shear * (shear * shear) - law.cross * (x * z));
}

// p of the quadrants.
INLINE Quarters yield_forms(const Between& row, const Differences& d) {
  return {yield_form(row.below, d.xw, d.zs, d.sw), yield_form(row.below, d.xe, d.zs, d.se), yield_form(row.above, d.xw, d.zn, d.nw),
          yield_form(row.above, d.xe, d.zn, d.ne)};
}

// What yielding takes from a quadrant, nothing where p <= 1; returns the secant factor.
template <bool clips>
INLINE Wide yield(const Yielding& law, Wide p, Wide x, Wide z, Wide shear, Wide& drive, Wide& stored) {
  const Wide beyond = larger(p, all(Real(1))), r = Real(1) / root(beyond), past = beyond * r - Real(1), lost = Real(1) - r;
  drive -= law.drive * lost * (clips ? yield_form(law, driving<clips>(x), driving<clips>(z), shear) : beyond);
  stored -= law.energy * (past * past);
  return Real(1) - law.soft * lost;
}

// Tiles that will yield before long do not rest: what they took up elastically past sigma_y the potential would not give back. Of p.
constexpr Real near_yield = Real(0.5);

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

// Where a row's secant factors are.
struct Reductions {
  Real *sw, *se, *nw, *ne;
};
INLINE void put(const Reductions& reduction, Index i, const Quarters& s) {
  store(reduction.sw + i, s.sw), store(reduction.se + i, s.se), store(reduction.nw + i, s.nw), store(reduction.ne + i, s.ne);
}

// Flags of a tile. Of nodes that a crack holds nothing but the residual stiffness is left, and an open crack's strain is no strain of the
// metal: they do not make a tile yield.
INLINE unsigned char yielding_of(const View& v, const Between& at, const Real* whole, Index tile) {
  bool yields = !v.tests_yield, nearly = false;
  for (Index i = tile; i < tile + lanes; i += width) {
    const Quarters p = yield_forms(at, differences(at, i));
    const Wide most = load(whole + i) * larger(larger(p.sw, p.se), larger(p.nw, p.ne));
    yields = yields || any_above(most, Real(1));
    nearly = nearly || any_above(most, near_yield);
  }
  return yields ? does_yield : nearly ? nearly_yields : 0;
}

// A tile that may yield: elastic first, and once more where it does.
template <bool clips>
INLINE void secant_history(const Row& row, const Between& at, const Reductions& reduction, Index i, Real nearer, bool yields) {
  const Differences d = differences(at, i);
  Wide stored = elastic_energy(at, d);
  Quarters drives = elastic_drives<clips>(at, d);
  if (yields) {
    const Quarters p = yield_forms(at, d);
    const Wide sw = yield<clips>(at.below, p.sw, d.xw, d.zs, d.sw, drives.sw, stored);
    const Wide se = yield<clips>(at.below, p.se, d.xe, d.zs, d.se, drives.se, stored);
    const Wide nw = yield<clips>(at.above, p.nw, d.xw, d.zn, d.nw, drives.nw, stored);
    const Wide ne = yield<clips>(at.above, p.ne, d.xe, d.zn, d.ne, drives.ne, stored);
    put(reduction, i, {sw, se, nw, ne});
  }
  commit(row, i, nearer, stored, drives.sw, drives.se, drives.nw, drives.ne);
}

template <bool clips>
INLINE void plastic_history(const View& v, int j) {
  const Row row = row_of(v, j);
  const Between at = between(v, j);
  const Index begin = row_at(v, j);
  const Reductions reduction{v.reduction[0] + begin, v.reduction[1] + begin, v.reduction[2] + begin, v.reduction[3] + begin};
  over_tiles(
      v, j, [&](Index tile, Index flag) __attribute__((always_inline)) {
        const Wide one = all(Real(1));
        const unsigned char before = v.yields[flag], now = yielding_of(v, at, v.whole_nodes + begin, tile);
        const Real share = nearer(v, flag);
        for (Index i = tile; i < tile + lanes; i += width) {
          secant_history<clips>(row, at, reduction, i, share, now == does_yield);
          if (before == does_yield && now != does_yield) put(reduction, i, {one, one, one, one});
        }
        v.yields[flag] = now;
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
