// The internal force of linear elastic quadrants, f = -B^T g C epsilon, gathered node by node from the nine nodes around: the four
// quadrants of a node share its g, so that sums over them collapse to differences. What yielding or a split changes comes on top
// (force.cpp).
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {
namespace {

using Differenced = phasefield::Differenced<Real>;

// Stiffness of the elements above and below a row of nodes, and of the edges along x between both.
struct Law {
  Differenced n, s;
  Real along_x, along_z;  // against differences of u_x, of u_z
};

INLINE Law law_of(const View& v, int j) {
  return {v.element_rows[j + 1].force, v.element_rows[j].force, v.node_rows[j].along_x, v.node_rows[j].along_z};
}

struct Nodes {
  Around u;
  const Real *g, *g_south, *g_north;
};

struct Force {
  Real x, z;
};

// Differences across a node, of the node row and those above and below.
INLINE Real across(const Real* a, Index i) { return a[i + 1] - a[i - 1]; }

// What the edges along x give: the normal force of the differences along the edges, and the cross terms of the nodes left and right.
INLINE Force along_edges(const Law& c, const Nodes& at, Index i) {
  const Real east = at.g[i] + at.g[i + 1], west = at.g[i - 1] + at.g[i];
  const Real *x = at.u.x, *z = at.u.z;
  return {c.along_x * (east * (x[i + 1] - x[i]) - west * (x[i] - x[i - 1])),
          c.along_z * (east * (z[i + 1] - z[i]) - west * (z[i] - z[i - 1]))};
}

// The stress of a node that acts on its edges along x, less its own differences along them.
INLINE Force cross(const Law& c, const Nodes& at, Index i) {
  const Around& u = at.u;
  const Real xn = u.x_north[i] - u.x[i], xs = u.x[i] - u.x_south[i], zn = u.z_north[i] - u.z[i], zs = u.z[i] - u.z_south[i];
  return {at.g[i] * (c.n.c13 * zn + c.s.c13 * zs), at.g[i] * (c.n.shear * xn + c.s.shear * xs)};
}

// What the edges along z give, without the column's weight.
INLINE Force up_and_down(const Law& c, const Nodes& at, Index i) {
  const Around& u = at.u;
  const Real g = at.g[i], gn = at.g_north[i], gs = at.g_south[i], two = Real(2);
  const Real north = g + gn, south = g + gs, x = across(u.x, i), z = across(u.z, i);
  const Real xn = u.x_north[i] - u.x[i], xs = u.x[i] - u.x_south[i], zn = u.z_north[i] - u.z[i], zs = u.z[i] - u.z_south[i];
  return {two * (c.n.c55 * (north * xn) - c.s.c55 * (south * xs)) +
              (c.n.shear * (g * z + gn * across(u.z_north, i)) - c.s.shear * (g * z + gs * across(u.z_south, i))),
          two * (c.n.c33 * (north * zn) - c.s.c33 * (south * zs)) +
              (c.n.c13 * (g * x + gn * across(u.x_north, i)) - c.s.c13 * (g * x + gs * across(u.x_south, i)))};
}

// A node between elements of two kinds, or at the top or bottom.
INLINE Force between(const Law& c, const Nodes& at, Index i, Real weight) {
  const Force edges = along_edges(c, at, i), east = cross(c, at, i + 1), west = cross(c, at, i - 1), vertical = up_and_down(c, at, i);
  return {edges.x + (east.x - west.x) + weight * vertical.x, edges.z + (east.z - west.z) + weight * vertical.z};
}

// At the left and the right side the place of a neighbour's stress is taken by the node's own.
INLINE void mend_sides(const View& v, const Law& c, const Nodes& at, Real* fx, Real* fz) {
  const Index last = v.columns - 1;
  const Force west = cross(c, at, -1), first = cross(c, at, 0), east = cross(c, at, v.columns), end = cross(c, at, last);
  fx[0] += west.x + first.x, fz[0] += west.z + first.z;
  fx[last] -= east.x + end.x, fz[last] -= east.z + end.z;
}

// A row between elements of two kinds, and its share of the stress integrals; `weight` is 1/2 at the sides, which have half of the edges
// along z.
INLINE void forces_between(const View& v, const Law& c, const Nodes& at, Real* fx, Real* fz, Sums& sums) {
  const Real *weight = v.column_weight, two = Real(2);
  const Around& u = at.u;
  Partial xx, zz;
  along_tiles(
      v.padded, TILE_BODY {
        const Real w = weight[i], weighted = w * at.g[i], x = across(u.x, i);
        const Force force = between(c, at, i, w);
        fx[i] = force.x, fz[i] = force.z;
        const Real zn = u.z_north[i] - u.z[i], zs = u.z[i] - u.z_south[i];
        xx.at[l] += weighted * (c.along_x * x + two * (c.n.c13 * zn + c.s.c13 * zs));
        zz.at[l] += weighted * (two * (c.n.c33 * zn + c.s.c33 * zs) + (c.n.c13 + c.s.c13) * x);
      });
  add(sums.stress_xx, xx, v.hx);
  add(sums.stress_zz, zz, v.hz);
}

}  // namespace

void elastic_forces(const View& v, int j, Real* fx, Real* fz, Sums& sums) {
  const Law c = law_of(v, j);
  const Real* g = v.degradation + row_at(v, j);
  const Nodes at{around(v, j), g, g - v.stride, g + v.stride};
  forces_between(v, c, at, fx, fz, sums);
  mend_sides(v, c, at, fx, fz);
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
