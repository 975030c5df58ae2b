// Sweeps of the psi equation G_c (psi/w_0 - w_0 lap psi) = 2 (1 - psi) H with mirrored sides, and the surface functional.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

INLINE void mirror(const View& v, Real* row) {
  row[-1] = row[1];
  row[v.columns] = row[v.columns - 2];
}

INLINE Wide within_bounds(Wide psi) { return smaller(larger(psi, Wide{}), all(Real(1))); }
INLINE Wide absolute(Wide x) { return larger(x, -x); }

// body(i) for the nodes of a row that are worked on, as many as an instruction handles.
template <class Body>
INLINE void over_nodes(const View& v, int j, const Body& body) {
  const Run *run = v.runs + v.run_begin[j], *last = v.runs + v.run_begin[j + 1];
  for (; run < last; ++run)
    for (Index i = run->begin, end = run->end; i < end; i += width) body(i);
}
#define NODES_BODY [&](Index i) __attribute__((always_inline))

// z = (source + sum of c psi_neighbour) / diagonal, the Jacobi image of the equation.
template <bool first, bool last>
INLINE Real sweep_row(const View& v, int j, const Real* psi, Real* next, Real omega) {
  const NodeRow& row = v.node_rows[j];
  const Real side = row.side, to_south = row.south, to_north = row.north;
  const Index at = row_at(v, j);
  const Real* here = psi + at;
  const Real *south = j > 0 ? here - v.stride : here + v.stride, *north = j + 1 < v.rows ? here + v.stride : here - v.stride;
  const Real *source = v.source + at, *inverse = v.inverse_diagonal + at, *whole = v.whole_nodes + at;
  Real* out = next + at;
  Wide change{};
  over_nodes(
      v, j, NODES_BODY {
        const Wide along = side * (load(here + i - 1) + load(here + i + 1)), up = to_south * load(south + i) + to_north * load(north + i);
        const Wide z = load(inverse + i) * ((load(source + i) + along) + up);
        if (last) change = larger(load(whole + i) * absolute(z - load(here + i)), change);
        const Wide before = load(out + i), relaxed = first ? z : before + omega * (z - before);
        store(out + i, last ? within_bounds(relaxed) : relaxed);
      });
  mirror(v, out);
  return last ? largest(change) : Real(0);
}

}  // namespace

void guess(const View& v, int j, const Real* psi, Real* previous) {
  const Real* now = psi + row_at(v, j);
  Real* out = previous + row_at(v, j);
  over_nodes(
      v, j, NODES_BODY { store(out + i, within_bounds(Real(2) * load(now + i) - load(out + i))); });
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
  over_nodes(
      v, j, NODES_BODY { store(psi + at + i, load(fresh + i)); });
  mirror(v, psi + at);
  return change;
}

void rest(const View& v, int j, const Real* psi, Real* previous, Real* other) {
  const Real *now = psi + row_at(v, j), *whole = v.whole_nodes + row_at(v, j);
  Real *before = previous + row_at(v, j), *spare = other + row_at(v, j);
  Index flag = Index(j) * v.tiles;
  for (Index tile = 0; tile < v.padded; tile += lanes, ++flag) {
    const Real limit = v.moves[flag] ? v.moved_damage / Real(rest_steps) : v.moved_damage;
    bool moves = false;
    for (Index i = tile; i < tile + lanes; i += width)
      moves = moves || any_above(load(whole + i) * absolute(load(now + i) - load(before + i)), limit);
    v.moves[flag] = moves;
    for (Index i = tile; i < tile + lanes && !moves; i += width) store(before + i, load(now + i)), store(spare + i, load(now + i));
  }
  mirror(v, before), mirror(v, spare);
}

namespace {

// Rows with the same constants. Corner by corner, summed by nodes and edges: a node is a corner of the elements around it, an edge a side
// of those beside it. The first and the last tile have weights.
template <bool with_linear>
INLINE void surface_rows(const View& v, int begin, int end, const Real* psi, SurfaceParts& sums) {
  const Real* weight = v.column_weight;
  const Index last = v.padded - lanes;
  Partial square, single, along, up, inside;
#pragma omp simd
  for (Index l = 0; l < lanes; ++l) inside.at[l] = Real(int(last + l) < v.columns - 1);
  for (int j = begin; j < end; ++j) {
    const Real *here = psi + row_at(v, j), *north = j + 1 < v.rows ? here + v.stride : here;
    const auto tile = [&](Index first, const auto& node, const auto& edge) __attribute__((always_inline)) {
      along_tile(
          first, TILE_BODY {
            const Real x = here[i + 1] - here[i], z = north[i] - here[i];
            square.at[l] += node(i) * (here[i] * here[i]);
            if (with_linear) single.at[l] += node(i) * here[i];
            along.at[l] += edge(l) * (x * x);
            up.at[l] += node(i) * (z * z);
          });
    };
    const auto one = [](Index) __attribute__((always_inline)) { return Real(1); };
    const auto of_column = [&](Index i) __attribute__((always_inline)) { return weight[i]; };
    if (last > 0) tile(0, of_column, one);
    for (Index first = lanes; first < last; first += lanes) tile(first, one, one);
    tile(
        last, of_column, [&](Index l) __attribute__((always_inline)) { return inside.at[l]; });
  }
  const double area = 2.0 * v.corner_area, per_xx = area / (v.hx * v.hx), per_zz = 2.0 * area / (v.hz * v.hz);
  const ElementRow &below = v.element_rows[begin], &above = v.element_rows[begin + 1];
  const double both = double(below.surface_gradient) + double(above.surface_gradient);
  const double both_lengths = double(below.surface_length) + double(above.surface_length);
  add(sums.local, square, area * (double(below.surface_square) + double(above.surface_square)));
  if (with_linear) add(sums.local, single, area * (double(below.surface_linear) + double(above.surface_linear)));
  add(sums.gradient, along, per_xx * both);
  add(sums.gradient, up, per_zz * double(above.surface_gradient));
  add(sums.length, along, per_xx * both_lengths);
  add(sums.length, up, per_zz * double(above.surface_length));
}

}  // namespace

void surface(const View& v, int begin, int end, const Real* psi, SurfaceParts& sums) {
  if (v.element_rows[begin].surface_linear == Real(0) && v.element_rows[begin + 1].surface_linear == Real(0))
    surface_rows<false>(v, begin, end, psi, sums);
  else
    surface_rows<true>(v, begin, end, psi, sums);
}

bool differs(const Real* psi, Real limit, const unsigned char* marks, int count) {
  unsigned char any = 0;
#pragma omp simd reduction(| : any)
  for (int i = 0; i < count; ++i) any = static_cast<unsigned char>(any | ((psi[i] > limit) ^ marks[i]));
  return any != 0;
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
