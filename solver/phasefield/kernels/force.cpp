// Degradation, what it releases, and the internal force f = -B^T sigma of all that is not linear elastic (elastic.cpp), from the quadrants
// of one row of nodes at a time.
#include "solver/law/degradation.hpp"
#include "solver/phasefield/kernels/quadrants.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

// What a node releases in a step: (g_n - g_n+1) sqrt(W_n W_n+1). The scheme itself exchanges 1/2 eps_n : C : eps_n+1 there, which this is
// where the strain grows in proportion; the arithmetic mean left the ledger four times as open (0.23 % against 0.06 % in shale).
INLINE void degrade_row(const View& v, int j, const Real* psi, const Real* before, Partial& released, Partial& elastic) {
  const Index at = row_at(v, j);
  const Real *now_row = psi + at, *before_row = before + at, *stored = v.stored + at, *stored_before = v.stored_before + at;
  const Real *weight = v.column_weight, eta = v.eta;
  Real* degradation = v.degradation + at;
  along_worked_tiles(
      v, j, TILE_BODY {
        const Real g = law::degradation(now_row[i], eta);
        const Real drop = law::degradation(before_row[i], eta) - g;
        degradation[i] = g;
        elastic.at[l] += weight[i] * g * stored[i];
        released.at[l] += weight[i] * drop * std::sqrt(larger(stored_before[i] * stored[i], Real(0)));
      });
  degradation[-1] = -degradation[0];
  degradation[v.columns] = -degradation[v.columns - 1];
}

}  // namespace

void degrade(const View& v, int begin, int end, const Real* psi, const Real* before, Sums& sums) {
  Partial released, elastic;
  for (int j = begin; j < end; ++j)
    if (v.run_begin[j] < v.run_begin[j + 1]) degrade_row(v, j, psi, before, released, elastic);
  add(sums.released, released, v.corner_area);
  add(sums.elastic, elastic, v.corner_area);
}

namespace {

struct WideStress {
  Wide xx, zz, xz;
};

INLINE void put(Real* to, Real value) { *to = value; }
INLINE void put(Real* to, Wide value) { store(to, value); }

// From the stress of each quadrant, degraded, to forces on the edges. Number: Real or Wide.
class QuadrantForces {
 public:
  QuadrantForces(const View& v, const HalfEdges& out) : out_(out), x_(Real(v.corner_area / v.hx)), z_(Real(v.corner_area / v.hz)) {}

  // Adds the nodes' stress to the sums.
  template <class Number, class Quadrant>
  INLINE void add(Index i, Number weight, const Quadrant& sw, const Quadrant& se, const Quadrant& nw, const Quadrant& ne, Number& xx,
                  Number& zz) const {
    const Number z = weight * z_;
    const Number east_x = x_ * (ne.xx + se.xx), west_x = x_ * (nw.xx + sw.xx), east_z = x_ * (ne.xz + se.xz), west_z = x_ * (nw.xz + sw.xz);
    const Number north_x = z * (ne.xz + nw.xz), south_x = z * (se.xz + sw.xz), north_z = z * (ne.zz + nw.zz), south_z = z * (se.zz + sw.zz);
    put(out_.east_x + i, east_x), put(out_.east_z + i, east_z), put(out_.west_x + i, west_x), put(out_.west_z + i, west_z);
    put(out_.north_x + i, north_x), put(out_.north_z + i, north_z), put(out_.south_x + i, south_x), put(out_.south_z + i, south_z);
    put(out_.own_x + i, (east_x - west_x) + (north_x - south_x)), put(out_.own_z + i, (east_z - west_z) + (north_z - south_z));
    xx += weight * (east_x + west_x), zz += north_z + south_z;
  }

 private:
  HalfEdges out_;
  Real x_, z_;
};

// Beside tiles that give all nothing acts, and the tiles there take what these give at the common edge; outside the sides the inner
// quadrants are mirrored.
INLINE void close_ends(const View& v, unsigned char* gives, const HalfEdges& out, Index t) {
  const Index last = v.columns - 1, tile = t * lanes, end = tile + lanes;
  if (t == 0)
    out.east_x[-1] = -out.west_x[0], out.east_z[-1] = -out.west_z[0];
  else if (gives[t - 1] != gives_all)
    gives[t - 1] = gives_parts, out.east_x[tile - 1] = out.east_z[tile - 1] = Real(0);
  if (end > last)
    out.west_x[last + 1] = -out.east_x[last], out.west_z[last + 1] = -out.east_z[last];
  else if (gives[t + 1] != gives_all)
    gives[t + 1] = gives_parts, out.west_x[end] = out.west_z[end] = Real(0);
}

INLINE void finish(const View& v, unsigned char* gives, const HalfEdges& out) {
  for (Index t = 0; t < v.tiles; ++t)
    if (gives[t] == gives_all) close_ends(v, gives, out, t);
}

// What yielding takes from the elastic stress: the share 1 - s of mu, the bulk modulus kept. `soft` is g times the part of mu that is lost
// where r = 0.
INLINE WideStress yielded_stress(Wide soft, Wide p, Wide xx, Wide zz, Wide xz) {
  const Wide lost = soft * (Real(1) - yield_over_q(p)), third = Real(2.0 / 3.0) * lost;
  return {third * (zz - Real(2) * xx), third * (xx - Real(2) * zz), -(lost * xz)};
}

// Constants of a row that may yield.
struct Softening {
  Between at;
  Real n, s;  // of mu
  Real per_hx, per_hz;
};

INLINE Softening softening(const View& v, int j) {
  const ElementRow &n = v.element_rows[j + 1], &s = v.element_rows[j];
  return {between(v, j), n.yielding.soft * n.stiffness.C55, s.yielding.soft * s.stiffness.C55, Real(1.0 / v.hx), Real(1.0 / v.hz)};
}

INLINE void yielded_tile(const View& v, const Softening& row, const QuadrantForces& forces, const Real* g, Index tile, Partial& xx,
                         Partial& zz) {
  for (Index part = 0; part < lanes; part += width) {
    const Index i = tile + part;
    const Differences d = differences(row.at, i);
    const Quarters p = yield_forms(row.at, d);
    const Wide n = row.n * load(g + i), s = row.s * load(g + i);
    const Wide xw = row.per_hx * d.xw, xe = row.per_hx * d.xe, zs = row.per_hz * d.zs, zn = row.per_hz * d.zn;
    const WideStress sw = yielded_stress(s, p.sw, xw, zs, row.per_hz * d.sw), se = yielded_stress(s, p.se, xe, zs, row.per_hz * d.se);
    const WideStress nw = yielded_stress(n, p.nw, xw, zn, row.per_hz * d.nw), ne = yielded_stress(n, p.ne, xe, zn, row.per_hz * d.ne);
    Wide sum_x = load(xx.at + part), sum_z = load(zz.at + part);
    forces.add(i, load(v.column_weight + i), sw, se, nw, ne, sum_x, sum_z);
    store(xx.at + part, sum_x), store(zz.at + part, sum_z);
  }
}

// Tiles that yielded, or nearly, when last looked at. All flags but 0 stay in a light step, so that they are looked at again.
INLINE void yielded_force(const View& v, int j, unsigned char* gives, Partial& xx, Partial& zz) {
  unsigned char *yields = v.yields + Index(j) * v.tiles, any = 0;
  for (Index t = 0; t < v.tiles; ++t) gives[t] = gives_nothing, any |= yields[t];
  if (!any) return;
  const Softening row = softening(v, j);
  const HalfEdges out = half_edges(v, j);
  const QuadrantForces forces(v, out);
  const Real *g = v.degradation + row_at(v, j), *whole = v.whole_nodes + row_at(v, j);
  bool found = false;
  for (Index t = 0; t < v.tiles; ++t) {
    if (!yields[t]) continue;
    const bool does = yielding_of(v, row.at, whole, t * lanes) == does_yield;
    if (does) yielded_tile(v, row, forces, g, t * lanes, xx, zz);
    yields[t] = does ? does_yield : nearly_yields, gives[t] = does ? gives_all : gives_nothing;
    found = found || does;
  }
  if (found) finish(v, gives, out);
}

template <class Law>
INLINE Stress split_stress(const Law& law, Real g, const Strain& e) {
  const Stress d = law.degraded_stress(e), k = law.kept_stress(e);
  return {g * d.xx + k.xx, g * d.zz + k.zz, g * d.xz + k.xz};
}

template <class Law>
INLINE void split_force(const View& v, int j, unsigned char* gives, Partial& xx, Partial& zz) {
  const Around u = around(v, j);
  const Law n = LawOf<Law>::make(v.element_rows[j + 1]), s = LawOf<Law>::make(v.element_rows[j]);
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz), *g = v.degradation + row_at(v, j), *weight = v.column_weight;
  const HalfEdges out = half_edges(v, j);
  const QuadrantForces forces(v, out);
  along_tiles(
      v.padded, TILE_BODY {
        const Quadrants e = strains(u, i, per_hx, per_hz);
        forces.add(i, weight[i], split_stress(s, g[i], e.sw), split_stress(s, g[i], e.se), split_stress(n, g[i], e.nw),
                   split_stress(n, g[i], e.ne), xx.at[l], zz.at[l]);
      });
  for (Index t = 0; t < v.tiles; ++t) gives[t] = gives_all;
  finish(v, gives, out);
}

// The law is chosen once for a row.
INLINE void force_row(const View& v, int j, Partial& xx, Partial& zz) {
  unsigned char* gives = v.gives + Index(j) * v.tiles;
  switch (v.law) {
    case RowLaw::seed:
    case RowLaw::none:
      return yielded_force(v, j, gives, xx, zz);
    case RowLaw::spectral:
      return split_force<law::SpectralSplit<Real>>(v, j, gives, xx, zz);
    case RowLaw::star_convex:
      return split_force<law::StarConvexSplit<Real>>(v, j, gives, xx, zz);
  }
}

}  // namespace

void force(const View& v, int begin, int end, Sums& sums) {
  Partial xx, zz;
  for (int j = begin; j < end; ++j) force_row(v, j, xx, zz);
  add(sums.stress_xx, xx, v.hx);
  add(sums.stress_zz, zz, v.hz);
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
