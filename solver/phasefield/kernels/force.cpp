// Degradation, what it releases, and the internal force f = -B^T sigma of all that is not linear elastic (elastic.cpp), from the quadrants
// of one row of nodes at a time.
#include "solver/law/degradation.hpp"
#include "solver/phasefield/kernels/quadrants.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

// Rows of the work on one row of nodes.
struct Rows {
  const Real* g;                // degradation
  Real *east_x, *east_z;        // on the edges to the right
  Real *west_x, *west_z;        // on the edges to the left
  Real *stress_xx, *stress_zz;  // summed over the quadrants
};

INLINE Rows rows_of(const View& v, int j) {
  const int k = first_free_row;
  return {v.degradation + row_at(v, j), scratch_row(v, k),     scratch_row(v, k + 1), scratch_row(v, k + 2),
          scratch_row(v, k + 3),        scratch_row(v, k + 4), scratch_row(v, k + 5)};
}

}  // namespace

// What a node releases in a step: (g_n - g_n+1) sqrt(W_n W_n+1). The scheme itself exchanges 1/2 eps_n : C : eps_n+1 there, which this is
// where the strain grows in proportion; the arithmetic mean left the ledger four times as open (0.23 % against 0.06 % in shale).
void degrade(const View& v, int j, const Real* psi, const Real* before, Sums& sums) {
  if (v.run_begin[j] == v.run_begin[j + 1]) return;
  const Index at = row_at(v, j);
  const Real *now_row = psi + at, *before_row = before + at, *stored = v.stored + at, *stored_before = v.stored_before + at;
  const Real *weight = v.column_weight, eta = v.eta;
  Real* degradation = v.degradation + at;
  Partial released, elastic;
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
  add(sums.released, released, v.corner_area);
  add(sums.elastic, elastic, v.corner_area);
}

namespace {

struct WideStress {
  Wide xx, zz, xz;
};

// Any law: from the stress of each quadrant, g degraded + kept.
class QuadrantForces {
 public:
  QuadrantForces(const View& v, const Rows& rows, const HalfEdges& out)
      : rows_(rows), out_(out), weight_(v.column_weight), x_(Real(v.corner_area / v.hx)), z_(Real(v.corner_area / v.hz)) {}

  INLINE void add(Index i, Stress sw, Stress se, Stress nw, Stress ne) const {
    add(i, weight_[i], sw, se, nw, ne, [](Real& to, Real value) { to = value; });
  }
  INLINE void add(Index i, const WideStress& sw, const WideStress& se, const WideStress& nw, const WideStress& ne) const {
    add(i, load(weight_ + i), sw, se, nw, ne, [](Real& to, Wide value) { store(&to, value); });
  }

 private:
  template <class Number, class Quadrant, class Put>
  INLINE void add(Index i, Number weight, const Quadrant& sw, const Quadrant& se, const Quadrant& nw, const Quadrant& ne,
                  const Put& put) const {
    const Number z = weight * z_, east = x_ * (ne.xx + se.xx), west = x_ * (nw.xx + sw.xx);
    const Number north = z * (ne.zz + nw.zz), south = z * (se.zz + sw.zz);
    put(rows_.east_x[i], east);
    put(rows_.west_x[i], west);
    put(rows_.east_z[i], x_ * (ne.xz + se.xz));
    put(rows_.west_z[i], x_ * (nw.xz + sw.xz));
    put(out_.north_z[i], north);
    put(out_.south_z[i], south);
    put(out_.north_x[i], z * (ne.xz + nw.xz));
    put(out_.south_x[i], z * (se.xz + sw.xz));
    put(rows_.stress_xx[i], weight * (east + west));
    put(rows_.stress_zz[i], north + south);
  }

  Rows rows_;
  HalfEdges out_;
  const Real* weight_;
  Real x_, z_;
};

// body(first node, tile) for the tiles of a row that give as said.
template <class Body>
INLINE void over_giving(const View& v, const unsigned char* gives, unsigned char what, const Body& body) {
  for (Index t = 0; t < v.tiles; ++t)
    if (gives[t] == what) body(t * lanes, t);
}

// Beside the tiles that give all nothing acts; outside the sides the inner quadrants are mirrored.
INLINE void close_ends(const View& v, const unsigned char* gives, const Rows& rows) {
  const Index last = v.columns - 1;
  over_giving(
      v, gives, gives_all, [&](Index tile, Index t) __attribute__((always_inline)) {
        const Index end = tile + lanes;
        if (t == 0 || gives[t - 1] != gives_all) rows.east_x[tile - 1] = rows.east_z[tile - 1] = Real(0);
        if (t + 1 == v.tiles || gives[t + 1] != gives_all) rows.west_x[end] = rows.west_z[end] = Real(0);
        if (t == 0) rows.east_x[-1] = -rows.west_x[0], rows.east_z[-1] = -rows.west_z[0];
        if (end > last) rows.west_x[last + 1] = -rows.east_x[last], rows.west_z[last + 1] = -rows.east_z[last];
      });
}

INLINE void finish_quadrants(const View& v, const unsigned char* gives, const Rows& rows, const HalfEdges& out, Sums& sums) {
  close_ends(v, gives, rows);
  Partial xx, zz;
  over_giving(
      v, gives, gives_all, [&](Index tile, Index) __attribute__((always_inline)) {
        along_tile(
            tile, TILE_BODY {
              out.part_x[i] =
                  (rows.east_x[i] + rows.west_x[i + 1]) - (rows.east_x[i - 1] + rows.west_x[i]) + (out.north_x[i] - out.south_x[i]);
              out.part_z[i] =
                  (rows.east_z[i] + rows.west_z[i + 1]) - (rows.east_z[i - 1] + rows.west_z[i]) + (out.north_z[i] - out.south_z[i]);
              xx.at[l] += rows.stress_xx[i];
              zz.at[l] += rows.stress_zz[i];
            });
      });
  add(sums.stress_xx, xx, v.hx);
  add(sums.stress_zz, zz, v.hz);
}

// The nodes next to tiles that give all.
INLINE void give_parts(const View& v, const unsigned char* gives, const Rows& rows, const HalfEdges& out) {
  over_giving(
      v, gives, gives_parts, [&](Index tile, Index t) __attribute__((always_inline)) {
        const Index last = tile + lanes - 1;
        along_tile(
            tile, TILE_BODY { out.part_x[i] = out.part_z[i] = Real(0); });
        if (t > 0 && gives[t - 1] == gives_all) out.part_x[tile] = -rows.east_x[tile - 1], out.part_z[tile] = -rows.east_z[tile - 1];
        if (t + 1 < v.tiles && gives[t + 1] == gives_all)
          out.part_x[last] = rows.west_x[last + 1], out.part_z[last] = rows.west_z[last + 1];
      });
}

// What yielding takes from the elastic stress: the share 1 - s of mu, the bulk modulus kept. `mu` is g times the part of mu that is lost
// where r = 0.
INLINE WideStress yielded_stress(Wide mu, Wide p, Wide xx, Wide zz, Wide xz) {
  const Wide lost = mu * (Real(1) - yield_over_q(p)), third = Real(2.0 / 3.0) * lost;
  return {third * (zz - Real(2) * xx), third * (xx - Real(2) * zz), -(lost * xz)};
}

// Tiles that yielded, or nearly, when last worked on. A light step leaves their flags so that they are looked at again.
INLINE void yielded_force(const View& v, int j, unsigned char* gives, const Rows& rows, const HalfEdges& out) {
  const Between at = between(v, j);
  const Real n = at.above.soft * v.element_rows[j + 1].stiffness.C55, s = at.below.soft * v.element_rows[j].stiffness.C55;
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz), *whole = v.whole_nodes + row_at(v, j);
  const QuadrantForces forces(v, rows, out);
  unsigned char* yields = v.yields + Index(j) * v.tiles;
  for (Index t = 0; t < v.tiles; ++t) {
    gives[t] = gives_nothing;
    if (!yields[t]) continue;
    yields[t] = yielding_of(v, at, whole, t * lanes) == does_yield ? does_yield : nearly_yields;
    if (yields[t] != does_yield) continue;
    gives[t] = gives_all;
    for (Index i = t * lanes; i < (t + 1) * lanes; i += width) {
      const Differences d = differences(at, i);
      const Quarters p = yield_forms(at, d);
      const Wide g = load(rows.g + i), xw = per_hx * d.xw, xe = per_hx * d.xe, zs = per_hz * d.zs, zn = per_hz * d.zn;
      forces.add(i, yielded_stress(s * g, p.sw, xw, zs, per_hz * d.sw), yielded_stress(s * g, p.se, xe, zs, per_hz * d.se),
                 yielded_stress(n * g, p.nw, xw, zn, per_hz * d.nw), yielded_stress(n * g, p.ne, xe, zn, per_hz * d.ne));
    }
  }
}

template <class Law>
INLINE Stress split_stress(const Law& law, Real g, const Strain& e) {
  const Stress d = law.degraded_stress(e), k = law.kept_stress(e);
  return {g * d.xx + k.xx, g * d.zz + k.zz, g * d.xz + k.xz};
}

template <class Law>
INLINE void split_force(const View& v, int j, const Rows& rows, const HalfEdges& out) {
  const Around u = around(v, j);
  const Law n = LawOf<Law>::make(v.element_rows[j + 1]), s = LawOf<Law>::make(v.element_rows[j]);
  const Real per_hx = Real(1.0 / v.hx), per_hz = Real(1.0 / v.hz);
  const QuadrantForces forces(v, rows, out);
  const Real* degradation = rows.g;
  along_row(
      v.padded, ROW_BODY {
        const Quadrants e = strains(u, i, per_hx, per_hz);
        const Real g = degradation[i];
        forces.add(i, split_stress(s, g, e.sw), split_stress(s, g, e.se), split_stress(n, g, e.nw), split_stress(n, g, e.ne));
      });
}

// The law is chosen once for a row.
INLINE void quadrant_forces(const View& v, int j, unsigned char* gives, const Rows& rows, const HalfEdges& out) {
  for (Index t = 0; t < v.tiles; ++t) gives[t] = gives_all;
  switch (v.law) {
    case RowLaw::seed:
    case RowLaw::none:
      return yielded_force(v, j, gives, rows, out);
    case RowLaw::spectral:
      return split_force<law::SpectralSplit<Real>>(v, j, rows, out);
    case RowLaw::star_convex:
      return split_force<law::StarConvexSplit<Real>>(v, j, rows, out);
  }
}

// Tiles beside those that give all take a part at the edges between. True where a tile gives.
INLINE bool find_parts(const View& v, unsigned char* gives) {
  bool found = false;
  for (Index t = 0; t < v.tiles; ++t) {
    if (gives[t] != gives_all) continue;
    found = true;
    if (t > 0 && gives[t - 1] == gives_nothing) gives[t - 1] = gives_parts;
    if (t + 1 < v.tiles && gives[t + 1] == gives_nothing) gives[t + 1] = gives_parts;
  }
  return found;
}

}  // namespace

void force(const View& v, int j, Sums& sums) {
  unsigned char* gives = v.gives + Index(j) * v.tiles;
  const Rows rows = rows_of(v, j);
  const HalfEdges out = half_edges(v, j);
  quadrant_forces(v, j, gives, rows, out);
  if (!find_parts(v, gives)) return;
  finish_quadrants(v, gives, rows, out, sums);
  give_parts(v, gives, rows, out);
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
