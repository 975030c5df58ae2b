// Joints: traction over each edge from the opening between its triangles, with two Gauss points (law/joint.hpp). While nothing is damaged
// the traction is p delta in every direction, and the forces at the ends are those of the consistent spring, p L / 6 (2 delta_a + delta_b):
// no direction is needed. Joints that an end of opens past the smaller onset are followed from then on, in blocks of their own.
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

struct Answer {
  Ends force;
  Lanes damage_0, damage_1;
  Mask damaged, breaks;
};

// Forces of the left triangle at both ends, with damage. `along` is the unit tangent of the line midway.
template <class Curve>
INLINE Answer follow_ends(const Joint& law, const Vector& along, Lanes length, const Ends& opening, Lanes damage_0, Lanes damage_1) {
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

INLINE Sides load_sides(const View& view, const JointPlaces<Real>& joints, int b, int s) {
  const Index joint = Index(b) * lanes + s * width;
  const int *left = joints.left_row + joint, *right = joints.right_row + joint;
  const Real* rows = view.rows;
  return {load_rows(LANE_AT { return rows + left[l]; }), load_rows(LANE_AT { return rows + right[l]; })};
}

INLINE void store_sides(const View& view, const JointPlaces<Real>& joints, int b, int s, const Ends& f) {
  const Index joint = Index(b) * lanes + s * width;
  const int *left = joints.left_slot + joint, *right = joints.right_slot + joint;
  Real* slots = view.slots;
  store_rows(LANE_AT { return slots + left[l]; }, {f.ax, f.az, f.bx, f.bz});
  store_rows(LANE_AT { return slots + right[l]; }, {-f.bx, -f.bz, -f.ax, -f.az});
}

INLINE Ends opening_between(const Sides& u) {
  return {u.right.c - u.left.a, u.right.d - u.left.b, u.right.a - u.left.c, u.right.b - u.left.d};
}

INLINE Lanes spring_of(const View& view, const JointPlaces<Real>& joints, int b, int s) {
  const law::Joint<Real>& law = view.joint_laws[joints.law_of_block[b]];
  return Lanes(law.penalty * Real(1.0 / 6.0)) * load(joints.length + Index(b) * lanes + s * width);
}

INLINE Ends spring_force(Lanes spring, const Ends& o) {
  const Lanes x = o.ax + o.bx, z = o.az + o.bz;
  return {spring * (o.ax + x), spring * (o.az + z), spring * (o.bx + x), spring * (o.bz + z)};
}

// One register of followed joints. The work that is gone in a step is 1/2 (f0 delta1 - f1 delta0): the trapezoidal work less the growth of
// what is stored.
template <class Curve>
INLINE bool follow_part(const View& view, int b, int s, LaneSums& gone) {
  const Joint law = wide(view.joint_laws[view.followed.law_of_block[b]]);
  const Sides u = load_sides(view, view.followed, b, s);
  const Ends opening = opening_between(u);
  Real* damage = view.damage + Index(b) * 2 * lanes + s * width;
  Real* opening_at = view.opening + Index(b) * 4 * lanes + s * width;
  Real* force_at = view.force + Index(b) * 4 * lanes + s * width;
  const Lanes length = load(view.followed.length + Index(b) * lanes + s * width), zero(Real(0)), half(Real(0.5));
  const Answer now = follow_ends<Curve>(law, midline(view, b, s, u), length, opening, load(damage), load(damage + lanes));
  const Ends force = choose(now.damaged, now.force, spring_force(spring_of(view, view.followed, b, s), opening));
  const Lanes lost = half * (dot(load_ends(force_at), opening) - dot(force, load_ends(opening_at)));
  gone.part[s] = gone.part[s] + select(now.damaged, lost, zero);
  store(damage, now.damage_0), store(damage + lanes, now.damage_1);
  store_ends(opening_at, opening), store_ends(force_at, force);
  store_sides(view, view.followed, b, s, force);
  return any(now.breaks);
}

template <class Curve>
INLINE double follow_with(const View& view, Blocks blocks) {
  LaneSums gone;
  for (int b = blocks.begin; b < blocks.end; ++b) {
    bool breaks = false;
    for (int s = 0; s < parts; ++s) breaks |= follow_part<Curve>(view, b, s, gone);
    view.breaks[b] = breaks;
  }
  return gone.total();
}

INLINE Lanes furthest(const Ends& o) { return larger(o.ax * o.ax + o.az * o.az, o.bx * o.bx + o.bz * o.bz); }

}  // namespace

void join(const View& view, Blocks blocks) {
  for (int b = blocks.begin; b < blocks.end; ++b) {
    bool stretched = false;
#pragma GCC unroll 4
    for (int s = 0; s < parts; ++s) {
      const Ends opening = opening_between(load_sides(view, view.springs, b, s));
      store_sides(view, view.springs, b, s, spring_force(spring_of(view, view.springs, b, s), opening));
      stretched |= any(furthest(opening) > load(view.reach + Index(b) * lanes + s * width));
    }
    view.stretched[b] = stretched;
  }
}

double follow(const View& view, Blocks blocks) {
  return view.curve == Curve::munjiza ? follow_with<law::Munjiza>(view, blocks) : follow_with<law::LinearSoftening>(view, blocks);
}

double stored(const View& view, Blocks blocks) {
  LaneSums sums;
  for (int b = blocks.begin; b < blocks.end; ++b)
    for (int s = 0; s < parts; ++s) {
      const Ends opening = opening_between(load_sides(view, view.springs, b, s));
      sums.part[s] = sums.part[s] + dot(spring_force(spring_of(view, view.springs, b, s), opening), opening);
    }
  return 0.5 * sums.total();
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
