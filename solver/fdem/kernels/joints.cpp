// Joints that have not been damaged yet: the traction is p delta in every direction, and the forces at the ends are those of the consistent
// spring, p L / 6 (2 delta_a + delta_b). No direction is needed, but where an end is open further than the smaller onset: there the law
// (law/joint.hpp) tells whether a joint softens, and must be followed from now on (followed.cpp).
#include "solver/fdem/kernels/edges.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {
namespace {

INLINE Lanes furthest(const Ends& o) { return larger(o.ax * o.ax + o.az * o.az, o.bx * o.bx + o.bz * o.bz); }

INLINE bool join_part(const View& view, int b, int s) {
  const Ends left = load_side(view, view.springs.left_row, b, s), right = load_side(view, view.springs.right_row, b, s);
  const Ends opening = law::opening_between(left, right);
  store_sides(view, view.springs, b, s, spring_force(spring_of(view, view.springs, b, s), opening));
  const Mask stretched = furthest(opening) > Lanes(view.reach[view.springs.law_of_block[b]]);
  if (!any(stretched)) return false;
  return any(stretched & law::overstretched(law_of(view, view.springs, b), opening, midline(view.springs, b, s, left, right)));
}

}  // namespace

void join(const View& view, Blocks blocks) {
  for (int b = blocks.begin; b < blocks.end; ++b) {
    bool softens = false;
#pragma GCC unroll 4
    for (int s = 0; s < parts; ++s) softens |= join_part(view, b, s);
    view.softens[b] = softens;
  }
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
