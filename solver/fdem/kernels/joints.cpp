// Joints: traction over each edge from the opening between its triangles, with two Gauss points (law/joint.hpp). While nothing is damaged
// the traction is p delta in every direction, and the forces at the ends are those of the consistent spring, p L / 6 (2 delta_a + delta_b):
// no direction is needed. Damage arithmetic runs in those blocks alone where an end opens past the smaller onset, or D > 0.
#include "solver/fdem/kernels/lanes.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {

using Joint = law::Joint<Lanes>;

namespace {

// At both ends of the edges.
struct Ends {
  Lanes ax, az, bx, bz;
};

INLINE Ends load_ends(const Real* at) { return {load(at), load(at + lanes), load(at + 2 * lanes), load(at + 3 * lanes)}; }
INLINE void store_ends(Real* at, const Ends& e) {
  store(at, e.ax), store(at + lanes, e.az), store(at + 2 * lanes, e.bx), store(at + 3 * lanes, e.bz);
}
INLINE Lanes dot(const Ends& p, const Ends& q) { return (p.ax * q.ax + p.az * q.az) + (p.bx * q.bx + p.bz * q.bz); }
INLINE Ends choose(Mask m, const Ends& p, const Ends& q) {
  return {select(m, p.ax, q.ax), select(m, p.az, q.az), select(m, p.bx, q.bx), select(m, p.bz, q.bz)};
}

struct Vector {
  Lanes x, z;
};

inline constexpr double near = 0.5 + 0.28867513459481287, far = 0.5 - 0.28867513459481287;  // Gauss points: weights of the ends

struct Point {
  Lanes damage;
  Vector traction;
};

template <class Curve>
INLINE Point at_point(const Joint& law, const Vector& along, const Vector& opening, Lanes damage) {
  const law::Opening<Lanes> parts{opening.x * along.z - opening.z * along.x, opening.x * along.x + opening.z * along.z};
  const auto answer = law::answer<Curve>(law, parts, damage);
  return {answer.damage, {answer.normal * along.z + answer.shear * along.x, answer.shear * along.z - answer.normal * along.x}};
}

struct Followed {
  Ends force;
  Lanes damage_0, damage_1;
  Mask damaged, breaks;
};

// Forces of the left triangle at both ends, with damage. `along` is the unit tangent of the line midway.
template <class Curve>
INLINE Followed follow(const Joint& law, const Vector& along, Lanes length, const Ends& opening, Lanes damage_0, Lanes damage_1) {
  const Lanes w(near), x(far);
  const Point p = at_point<Curve>(law, along, {w * opening.ax + x * opening.bx, w * opening.az + x * opening.bz}, damage_0);
  const Point q = at_point<Curve>(law, along, {x * opening.ax + w * opening.bx, x * opening.az + w * opening.bz}, damage_1);
  const Lanes half = Lanes(Real(0.5)) * length, zero(Real(0)), one(Real(1));
  const Mask whole = one > smaller(p.damage, q.damage), was_whole = one > smaller(damage_0, damage_1);
  const auto end = [&](Lanes near_t, Lanes far_t) __attribute__((always_inline)) {
    return select(whole, half * (w * near_t + x * far_t), zero);
  };
  const Ends force{end(p.traction.x, q.traction.x), end(p.traction.z, q.traction.z), end(q.traction.x, p.traction.x),
                   end(q.traction.z, p.traction.z)};
  return {force, p.damage, q.damage, larger(p.damage, q.damage) > zero, was_whole & ~whole};
}

struct Sides {
  Lanes4 left, right;  // displacements: left from a to b, right from b to a
};

INLINE Vector midline(const View& view, int b, int s, const Sides& u) {
  const Real* at = view.along + Index(b) * 2 * lanes + s * width;
  const Lanes half(Real(0.5));
  const Lanes x = load(at) + half * ((u.left.c - u.left.a) + (u.right.a - u.right.c));
  const Lanes z = load(at + lanes) + half * ((u.left.d - u.left.b) + (u.right.b - u.right.d));
  const Lanes per_length = Lanes(Real(1)) / sqrt(x * x + z * z);
  return {x * per_length, z * per_length};
}

INLINE Joint wide(const law::Joint<Real>& joint) {
  return {joint.penalty, joint.per_onset_n, joint.per_onset_t, joint.per_rupture_n, joint.per_rupture_t};
}

// The opening one step earlier of joints that were springs then, from their force.
INLINE Ends opening_of(const Ends& f, Lanes spring) {
  const Lanes zero(Real(0)), one(Real(1)), two(Real(2));
  const Lanes per = select(spring > zero, one / select(spring > zero, Lanes(Real(3)) * spring, one), zero);
  return {per * (two * f.ax - f.bx), per * (two * f.az - f.bz), per * (two * f.bx - f.ax), per * (two * f.bz - f.az)};
}

struct Chunk {
  LaneSums stored, fracture;
};

// The damage arithmetic of one register; replaces the springs' force where there is damage. The work that is gone in a step is
// 1/2 (f0 delta1 - f1 delta0): the trapezoidal work less the growth of what is stored.
template <class Curve>
INLINE unsigned follow_part(const View& view, int b, int s, const Sides& u, const Ends& opening, Lanes spring, Ends& force, Lanes& gone) {
  const Index joint = Index(b) * lanes + s * width;
  const Joint law = wide(view.joint_laws[view.joint_law_of_block[b]]);
  Real* damage = view.damage + Index(b) * 2 * lanes + s * width;
  Real* kept = view.opening + Index(b) * 4 * lanes + s * width;
  const Lanes damage_0 = load(damage), damage_1 = load(damage + lanes);
  const Followed now = follow<Curve>(law, midline(view, b, s, u), load(view.length + joint), opening, damage_0, damage_1);
  const int* slot_of = view.left_slot + joint;
  const Lanes4 slot = load_rows(LANE_AT { return view.slots + slot_of[l]; });
  const Ends before{slot.a, slot.b, slot.c, slot.d};
  const bool followed = view.joint_state[b] & joint_followed;
  const Ends earlier = followed ? load_ends(kept) : opening_of(before, spring);
  force = choose(now.damaged, now.force, force);
  const Lanes zero(Real(0)), half(Real(0.5));
  gone = select(now.damaged, half * (dot(before, opening) - dot(force, earlier)), zero);
  store(damage, now.damage_0), store(damage + lanes, now.damage_1);
  store_ends(kept, opening);
  return unsigned(any(now.damaged) ? joint_damaged : 0) | unsigned(any(now.breaks) ? joint_broke : 0);
}

INLINE Sides load_sides(const View& view, int b, int s) {
  const Index joint = Index(b) * lanes + s * width;
  const int *left = view.left_row + joint, *right = view.right_row + joint;
  const Real* rows = view.rows;
  return {load_rows(LANE_AT { return rows + left[l]; }), load_rows(LANE_AT { return rows + right[l]; })};
}

INLINE void store_sides(const View& view, int b, int s, const Ends& f) {
  const Index joint = Index(b) * lanes + s * width;
  const int *left = view.left_slot + joint, *right = view.right_slot + joint;
  Real* slots = view.slots;
  store_rows(LANE_AT { return slots + left[l]; }, {f.ax, f.az, f.bx, f.bz});
  store_rows(LANE_AT { return slots + right[l]; }, {-f.bx, -f.bz, -f.ax, -f.az});
}

INLINE Ends opening_between(const Sides& u) {
  return {u.right.c - u.left.a, u.right.d - u.left.b, u.right.a - u.left.c, u.right.b - u.left.d};
}

INLINE Lanes spring_of(const View& view, const law::Joint<Real>& law, int b, int s) {
  return Lanes(law.penalty * Real(1.0 / 6.0)) * load(view.length + Index(b) * lanes + s * width);
}

INLINE Ends spring_force(Lanes spring, const Ends& o) {
  const Lanes x = o.ax + o.bx, z = o.az + o.bz;
  return {spring * (o.ax + x), spring * (o.az + z), spring * (o.bx + x), spring * (o.bz + z)};
}

INLINE void end_part(const View& view, int b, int s, const Ends& opening, const Ends& force, Chunk& sums) {
  store_sides(view, b, s, force);
  sums.stored.part[s] = sums.stored.part[s] + dot(force, opening);
}

// The block again, with damage. Apart from the springs' loop, which then keeps everything in registers.
template <class Curve>
[[gnu::noinline]] void follow_block(const View& view, int b, Chunk& sums) {
  const law::Joint<Real>& law = view.joint_laws[view.joint_law_of_block[b]];
  unsigned after = joint_followed | (view.joint_state[b] & joint_damaged);
  for (int s = 0; s < parts; ++s) {
    const Sides u = load_sides(view, b, s);
    const Ends opening = opening_between(u);
    const Lanes spring = spring_of(view, law, b, s);
    Ends force = spring_force(spring, opening);
    Lanes gone;
    after |= follow_part<Curve>(view, b, s, u, opening, spring, force, gone);
    sums.fracture.part[s] = sums.fracture.part[s] + gone;
    end_part(view, b, s, opening, force, sums);
  }
  view.joint_state[b] = static_cast<unsigned char>(after);
}

// True where an end of a joint is open past the smaller onset, in whatever direction.
INLINE bool is_stretched(const law::Joint<Real>& law, const Ends (&opening)[parts]) {
  const Real steepest = law.per_onset_n > law.per_onset_t ? law.per_onset_n : law.per_onset_t;
  Lanes furthest(Real(0));
#pragma GCC unroll 4
  for (const Ends& o : opening) furthest = larger(furthest, larger(o.ax * o.ax + o.az * o.az, o.bx * o.bx + o.bz * o.bz));
  return any(furthest * Lanes(steepest * steepest) > Lanes(Real(1)));
}

template <class Curve>
INLINE void join_block(const View& view, int b, Chunk& sums) {
  if (view.always_follow || (view.joint_state[b] & joint_damaged)) return follow_block<Curve>(view, b, sums);
  const law::Joint<Real>& law = view.joint_laws[view.joint_law_of_block[b]];
  Ends opening[parts];
#pragma GCC unroll 4
  for (int s = 0; s < parts; ++s) opening[s] = opening_between(load_sides(view, b, s));
  if (is_stretched(law, opening)) return follow_block<Curve>(view, b, sums);
  view.joint_state[b] = 0;
#pragma GCC unroll 4
  for (int s = 0; s < parts; ++s) end_part(view, b, s, opening[s], spring_force(spring_of(view, law, b, s), opening[s]), sums);
}

template <class Curve>
INLINE JointSums join_with(const View& view, Blocks blocks) {
  Chunk sums;
  for (int b = blocks.begin; b < blocks.end; ++b) join_block<Curve>(view, b, sums);
  return {0.5 * sums.stored.total(), sums.fracture.total()};
}

}  // namespace

JointSums join(const View& view, Blocks blocks) {
  return view.curve == Curve::munjiza ? join_with<law::Munjiza>(view, blocks) : join_with<law::LinearSoftening>(view, blocks);
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
