// The quadrants of a row of nodes in differences of the displacements, and where the secant law yields in them. Included by the kernels
// only.
#pragma once

#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {

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
  return {
      x - load(u.x + i - 1), load(u.x + i + 1) - x, z - load(u.z_south + i), load(u.z_north + i) - z, zw + xs, ze + xs, zw + xn, ze + xn};
}

struct Quarters {
  Wide sw, se, nw, ne;
};

INLINE Wide yield_form(const Yielding& law, Wide x, Wide z, Wide shear) {
  return (law.normal_x * (x * x) + law.normal_z * (z * z)) + (law.shear * (shear * shear) - law.cross * (x * z));
}

// p of the quadrants.
INLINE Quarters yield_forms(const Between& row, const Differences& d) {
  return {yield_form(row.below, d.xw, d.zs, d.sw), yield_form(row.below, d.xe, d.zs, d.se), yield_form(row.above, d.xw, d.zn, d.nw),
          yield_form(row.above, d.xe, d.zn, d.ne)};
}

// sigma_y / q past yield, 1 before it.
INLINE Wide yield_over_q(Wide p) { return Real(1) / root(larger(p, all(Real(1)))); }

// Tiles that will yield before long are looked at in every step: what they took up elastically past sigma_y the potential would not give
// back. Of p.
constexpr Real near_yield = Real(0.5);

// At least p of the four quadrants, from the largest squares around a node: |x z| <= (x^2 + z^2) / 2.
INLINE Wide bound_of_yield(const Between& row, const Differences& d) {
  const auto most = [&](Real above, Real below) __attribute__((always_inline)) { return larger(above, below); };
  const Real half = Real(0.5), x = most(row.above.normal_x + half * row.above.cross, row.below.normal_x + half * row.below.cross),
             z = most(row.above.normal_z + half * row.above.cross, row.below.normal_z + half * row.below.cross),
             shear = most(row.above.shear, row.below.shear);
  const Wide along_x = larger(d.xw * d.xw, d.xe * d.xe), along_z = larger(d.zs * d.zs, d.zn * d.zn);
  const Wide sheared = larger(larger(d.sw * d.sw, d.se * d.se), larger(d.nw * d.nw, d.ne * d.ne));
  return x * along_x + z * along_z + shear * sheared;
}

// False where no node of the tile can be near yield; a sixteenth is left for rounding.
INLINE bool may_yield(const View& v, const Between& at, const Real* whole, Index tile) {
  bool may = !v.tests_yield;
  for (Index i = tile; i < tile + lanes; i += width)
    may = may || any_above(load(whole + i) * bound_of_yield(at, differences(at, i)), near_yield * Real(15.0 / 16.0));
  return may;
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

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
