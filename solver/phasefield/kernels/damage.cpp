// Sweeps of the psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H with mirrored sides, and the surface functional.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

INLINE void mirror(const View& v, Real* row) {
  row[-1] = row[1];
  row[v.columns] = row[v.columns - 2];
}

INLINE Real within_bounds(Real psi) { return smaller(larger(psi, Real(0)), Real(1)); }

// z = (source + sum of c psi_neighbour) / diagonal, the Jacobi image of the equation.
template <bool first, bool last>
INLINE Real sweep_row(const View& v, int j, const Real* psi, Real* next, Real omega) {
  const NodeRow c = v.node_rows[j];
  const Index at = row_at(v, j);
  const Real* here = psi + at;
  const Real *south = j > 0 ? here - v.stride : here + v.stride, *north = j + 1 < v.rows ? here + v.stride : here - v.stride;
  const Real *source = v.source + at, *inverse = v.inverse_diagonal + at;
  const Real* whole = v.whole_nodes + at;
  Real* out = next + at;
  Partial change;
  along_worked_tiles(
      v, j, TILE_BODY {
        const Real z = inverse[i] * ((source[i] + c.side * (here[i - 1] + here[i + 1])) + (c.south * south[i] + c.north * north[i]));
        if (last) change.at[l] = larger(whole[i] * std::abs(z - here[i]), change.at[l]);
        const Real relaxed = first ? z : out[i] + omega * (z - out[i]);
        out[i] = last ? within_bounds(relaxed) : relaxed;
      });
  mirror(v, out);
  return last ? largest(change.at) : Real(0);
}

}  // namespace

void guess(const View& v, int j, const Real* psi, Real* previous) {
  const Real* now = psi + row_at(v, j);
  Real* out = previous + row_at(v, j);
  along_worked_tiles(
      v, j, TILE_BODY { out[i] = within_bounds(Real(2) * now[i] - out[i]); });
  mirror(v, out);
}

double sweep(const View& v, int j, const Real* psi, Real* next, Real omega, bool last) {
  if (omega == Real(1)) return last ? sweep_row<true, true>(v, j, psi, next, omega) : sweep_row<true, false>(v, j, psi, next, omega);
  return last ? sweep_row<false, true>(v, j, psi, next, omega) : sweep_row<false, false>(v, j, psi, next, omega);
}

double settle(const View& v, int j, Real* psi) {
  const Index at = row_at(v, j);
  Real* fresh = scratch_row(v, first_free_row);
  const Real change = sweep_row<true, true>(v, j, psi, fresh - at, Real(1));
  along_worked_tiles(
      v, j, TILE_BODY { psi[at + i] = fresh[i]; });
  mirror(v, psi + at);
  return change;
}

void rest(const View& v, int j, const Real* psi, Real* previous, Real* other) {
  const Real *now = psi + row_at(v, j), *whole = v.whole_nodes + row_at(v, j);
  Real *before = previous + row_at(v, j), *spare = other + row_at(v, j);
  Index flag = Index(j) * v.tiles;
  for (Index tile = 0; tile < v.padded; tile += lanes, ++flag) {
    Partial change;
    along_tile(
        tile, TILE_BODY { change.at[l] = whole[i] * std::abs(now[i] - before[i]); });
    v.moves[flag] = largest(change.at) > (v.moves[flag] ? v.moved_damage / Real(rest_steps) : v.moved_damage);
    if (!v.moves[flag])
      along_tile(
          tile, TILE_BODY { before[i] = spare[i] = now[i]; });
  }
  mirror(v, before), mirror(v, spare);
}

SurfaceSum surface(const View& v, int j, const Real* psi) {
  const Real *south = psi + row_at(v, j), *north = south + v.stride;
  Real *square = scratch_row(v, first_free_row), *linear = square + v.stride, *slope = linear + v.stride;
  const Real per_xx = Real(1.0 / (v.hx * v.hx)), per_zz = Real(1.0 / (v.hz * v.hz));
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    square[i] = (south[i] * south[i] + south[i + 1] * south[i + 1]) + (north[i] * north[i] + north[i + 1] * north[i + 1]);
    linear[i] = (south[i] + south[i + 1]) + (north[i] + north[i + 1]);
    const Real s = south[i + 1] - south[i], n = north[i + 1] - north[i], w = north[i] - south[i], e = north[i + 1] - south[i + 1];
    slope[i] = Real(2) * (per_xx * (s * s + n * n) + per_zz * (w * w + e * e));
  }
  for (Real* row : {square, linear, slope})
    for (Index i = v.columns - 1; i < v.padded; ++i) row[i] = Real(0);
  const ElementRow& row = v.element_rows[j + 1];
  const double gradient = v.corner_area * ordered_sum(slope, v.padded);
  const double local =
      double(row.surface_square) * ordered_sum(square, v.padded) + double(row.surface_linear) * ordered_sum(linear, v.padded);
  return {v.corner_area * local, double(row.surface_gradient) * gradient, double(row.surface_length) * gradient};
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
