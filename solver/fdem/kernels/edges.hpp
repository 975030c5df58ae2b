// Blocks of joints: the displacements of both their sides, their springs, and where forces go. For the kernels only.
#pragma once

#include "solver/fdem/kernels/lanes.hpp"
#include "solver/law/edge.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {

using Joint = law::Joint<Lanes>;
using Ends = law::Ends<Lanes>;
using Vector = law::Vector<Lanes>;
using Line = law::Line<Lanes>;
using Places = JointPlaces<Real>;

INLINE Ends load_ends(const Real* at) { return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes)}; }
INLINE void store_ends(Real* at, const Ends& e) {
  store(at, e.ax), store(at + lanes, e.az), store(at + 2 * lanes, e.bx), store(at + 3 * lanes, e.bz);
}
INLINE Lanes dot(const Ends& p, const Ends& q) { return (p.ax * q.ax + p.az * q.az) + (p.bx * q.bx + p.bz * q.bz); }
INLINE Ends choose(Mask m, const Ends& p, const Ends& q) {
  return {select(m, p.ax, q.ax), select(m, p.az, q.az), select(m, p.bx, q.bx), select(m, p.bz, q.bz)};
}

INLINE Joint law_of(const View& view, const Places& joints, int b) {
  const law::Joint<Real>& law = view.joint_laws[joints.law_of_block[b]];
  return {law.penalty, law.per_onset_n, law.per_onset_t, law.per_rupture_n, law.per_rupture_t};
}

// Displacements of one side, whose rows lie at `rows`. (Both sides in one structure are copied to memory and back by GCC 12.)
INLINE Ends load_side(const View& view, const int* rows, int b, int s) {
  const int* row = rows + Index(b) * lanes + s * width;
  const Real* u = view.rows;
  const Lanes4 x = load_rows(LANE_AT { return u + row[l]; });
  return {x.a, x.b, x.c, x.d};
}

// Forces of the left side at both ends, into the slots of both sides.
INLINE void store_sides(const View& view, const Places& joints, int b, int s, const Ends& f) {
  const Index joint = Index(b) * lanes + s * width;
  const int *left = joints.left_slot + joint, *right = joints.right_slot + joint;
  Real* slots = view.slots;
  store_rows(LANE_AT { return slots + left[l]; }, {f.ax, f.az, f.bx, f.bz});
  store_rows(LANE_AT { return slots + right[l]; }, {-f.bx, -f.bz, -f.ax, -f.az});
}

INLINE Line midline(const Places& joints, int b, int s, const Ends& left, const Ends& right) {
  const Real* at = joints.along + Index(b) * 2 * lanes + s * width;
  return law::midline(Vector{load(at), load(at + lanes)}, left, right);
}

INLINE Lanes length_of(const Places& joints, int b, int s) { return load(joints.length + Index(b) * lanes + s * width); }

INLINE Lanes spring_of(const View& view, const Places& joints, int b, int s) {
  return Lanes(view.joint_laws[joints.law_of_block[b]].penalty * Real(1.0 / 6.0)) * length_of(joints, b, s);
}

INLINE Ends spring_force(Lanes spring, const Ends& o) {
  const Lanes x = o.ax + o.bx, z = o.az + o.bz;
  return {spring * (o.ax + x), spring * (o.az + z), spring * (o.bx + x), spring * (o.bz + z)};
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
