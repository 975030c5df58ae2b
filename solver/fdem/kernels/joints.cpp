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

// Halfway between both sides of the edge, from its first node to its second, and the square of its length.
struct Line {
  Lanes x, z, square;
};

// One of the two points of an edge. The opening is times the length of the line, so that nothing need be made a unit vector.
struct Point {
  law::Opening<Lanes> opening;
  law::Extent<Lanes> size;
  Lanes r, damage, kept;
};

INLINE Point point_of(const Joint& law, const Line& line, const Vector& opening, Lanes damage, Lanes kept) {
  const law::Opening<Lanes> parts{opening.x * line.z - opening.z * line.x, opening.x * line.x + opening.z * line.z};
  const law::Extent<Lanes> size = law::extent(law, parts);
  return {parts, size, law::brittleness(size), damage, kept};
}

INLINE Mask grows(const Line& line, const Point& p) {
  const Lanes w = law::level(p.r, p.damage);
  return (p.size.rupture > w * w * line.square) & (Lanes(Real(1)) > p.damage);
}

template <class Curve>
INLINE void grow(const Line& line, Mask where, Point& p) {
  p.damage = select(where, law::grown(p.r, sqrt(p.size.rupture / line.square), p.damage), p.damage);
  p.kept = select(where, law::kept<Curve>(p.damage), p.kept);
}

// On the left side.
INLINE Vector traction(const Joint& law, const Line& line, const Point& p) {
  const Lanes w = law::level(p.r, p.damage), stiff = law.penalty / (w * line.square), soft = p.kept * p.r * stiff;
  const Lanes n = select(p.opening.n > Lanes(Real(0)), soft, w * stiff) * p.opening.n, t = soft * p.opening.t;
  return {n * line.z + t * line.x, t * line.z - n * line.x};
}

// Forces of the left side at both ends of edges that are not broken.
INLINE Ends ends_of(Mask whole, Lanes length, const Vector& p, const Vector& q) {
  const Lanes half = Lanes(Real(0.5)) * length, zero(Real(0)), w(near), x(far);
  const auto end = [&](Lanes near_t, Lanes far_t) __attribute__((always_inline)) {
    return select(whole, half * (w * near_t + x * far_t), zero);
  };
  return {end(p.x, q.x), end(p.z, q.z), end(q.x, p.x), end(q.z, p.z)};
}

struct Sides {
  Lanes4 left, right;  // displacements: left from a to b, right from b to a
};

INLINE Line midline(const View& view, int b, int s, const Sides& u) {
  const Real* at = view.along + Index(b) * 2 * lanes + s * width;
  const Lanes half(Real(0.5));
  const Lanes x = load(at) + half * ((u.left.c - u.left.a) + (u.right.a - u.right.c));
  const Lanes z = load(at + lanes) + half * ((u.left.d - u.left.b) + (u.right.b - u.right.d));
  return {x, z, x * x + z * z};
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

INLINE Mask is_whole(const Point& p, const Point& q) { return Lanes(Real(1)) > smaller(p.damage, q.damage); }

// One register of followed joints; true if one of them broke. The work that is gone in a step is 1/2 (f0 delta1 - f1 delta0): the
// trapezoidal work less the growth of what is stored. Most joints are not damaged further in a step: the curve is for those that are.
template <class Curve>
INLINE bool follow_part(const View& view, int b, int s, LaneSums& gone) {
  const Joint law = wide(view.joint_laws[view.followed.law_of_block[b]]);
  const Sides u = load_sides(view, view.followed, b, s);
  const Ends o = opening_between(u);
  const Line line = midline(view, b, s, u);
  Real *damage = view.damage + Index(b) * 2 * lanes + s * width, *kept = view.kept + Index(b) * 2 * lanes + s * width;
  const Lanes w(near), x(far), zero(Real(0)), half(Real(0.5));
  Point p = point_of(law, line, {w * o.ax + x * o.bx, w * o.az + x * o.bz}, load(damage), load(kept));
  Point q = point_of(law, line, {x * o.ax + w * o.bx, x * o.az + w * o.bz}, load(damage + lanes), load(kept + lanes));
  const Mask p_grows = grows(line, p), q_grows = grows(line, q);
  bool breaks = false;
  if (any(p_grows | q_grows)) {
    const Mask was_whole = is_whole(p, q);
    grow<Curve>(line, p_grows, p), grow<Curve>(line, q_grows, q);
    store(damage, p.damage), store(damage + lanes, q.damage);
    store(kept, p.kept), store(kept + lanes, q.kept);
    breaks = any(was_whole & ~is_whole(p, q));
  }
  const Mask damaged = larger(p.damage, q.damage) > zero;
  const Lanes length = load(view.followed.length + Index(b) * lanes + s * width);
  const Ends softened = ends_of(is_whole(p, q), length, traction(law, line, p), traction(law, line, q));
  const Ends force = choose(damaged, softened, spring_force(spring_of(view, view.followed, b, s), o));
  Real *opening_at = view.opening + Index(b) * 4 * lanes + s * width, *force_at = view.force + Index(b) * 4 * lanes + s * width;
  const Lanes lost = half * (dot(load_ends(force_at), o) - dot(force, load_ends(opening_at)));
  gone.part[s] = gone.part[s] + select(damaged, lost, zero);
  store_ends(opening_at, o), store_ends(force_at, force);
  store_sides(view, view.followed, b, s, force);
  return breaks;
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
