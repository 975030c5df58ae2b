// Followed joints: traction over each edge from the opening between its triangles, with two Gauss points (law/joint.hpp). A few blocks at a
// time go through short loops, so that the long way of a number through memory, divisions and roots is gone by many at once: openings, how
// they stretch the joints, the curve where they damage a joint further (few do in a step), forces, and the forces to both triangles.
#include "solver/fdem/kernels/edges.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {
namespace {

constexpr int batch_blocks = 16;  // whose openings stay in the nearest cache

// One of the two points of an edge: the opening times the length of the line, and r.
struct Point {
  law::Opening<Lanes> opening;
  Lanes r;
};

// One register of edges as they are opened.
struct Edges {
  Ends opening;
  Line line;
  Point p, q;
};

struct Damage {
  Lanes p, q;
};

// Where the numbers of a register of joints lie.
struct Place {
  Index pairs, fours;
  INLINE Place(int b, int s) : pairs(Index(b) * 2 * lanes + s * width), fours(Index(b) * 4 * lanes + s * width) {}
};

INLINE Damage load_pair(const Real* at) { return {load(at), load(at + lanes)}; }
INLINE void store_pair(Real* at, const Damage& d) { store(at, d.p), store(at + lanes, d.q); }
INLINE Mask is_whole(const Damage& d) { return Lanes(Real(1)) > smaller(d.p, d.q); }

INLINE Mask grows(const Line& line, const law::Extent<Lanes>& size, Lanes r, Lanes damage) {
  const Lanes w = law::level(r, damage);
  return (size.rupture > w * w * line.square) & (Lanes(Real(1)) > damage);
}

INLINE void open(const View& view, int b, int s, Edges& edges) {
  const Ends left = load_side(view, view.followed.left_row, b, s), right = load_side(view, view.followed.right_row, b, s);
  edges.opening = law::opening_between(left, right);
  edges.line = midline(view.followed, b, s, left, right);
}

// True where damage grows.
INLINE bool stretch(const View& view, int b, int s, Edges& edges) {
  const Joint law = law_of(view, view.followed, b);
  const law::Opening<Lanes> p = law::parts_of(law::near_a(edges.opening), edges.line),
                            q = law::parts_of(law::near_b(edges.opening), edges.line);
  const law::Extent<Lanes> p_size = law::extent(law, p), q_size = law::extent(law, q);
  edges.p = {p, law::brittleness(p_size)}, edges.q = {q, law::brittleness(q_size)};
  const Damage damage = load_pair(view.damage + Place(b, s).pairs);
  return any(grows(edges.line, p_size, edges.p.r, damage.p) | grows(edges.line, q_size, edges.q.r, damage.q));
}

template <class Curve>
INLINE Mask grow(const Joint& law, const Line& line, const Point& point, Lanes& damage, Lanes& kept) {
  const law::Extent<Lanes> size = law::extent(law, point.opening);
  const Mask where = grows(line, size, point.r, damage);
  damage = select(where, law::grown(point.r, sqrt(size.rupture / line.square), damage), damage);
  kept = select(where, law::kept<Curve>(damage), kept);
  return where;
}

// True where a joint broke.
template <class Curve>
INLINE bool soften(const View& view, int b, int s, const Edges& edges) {
  const Joint law = law_of(view, view.followed, b);
  const Place at(b, s);
  Damage damage = load_pair(view.damage + at.pairs), kept = load_pair(view.kept + at.pairs);
  const Mask was_whole = is_whole(damage);
  const Mask grew = grow<Curve>(law, edges.line, edges.p, damage.p, kept.p) | grow<Curve>(law, edges.line, edges.q, damage.q, kept.q);
  view.grew[b] |= static_cast<unsigned short>(bits(grew) << (s * width));
  store_pair(view.damage + at.pairs, damage), store_pair(view.kept + at.pairs, kept);
  return any(was_whole & ~is_whole(damage));
}

// On the left side.
INLINE Vector traction(const Joint& law, const Line& line, const Point& point, Lanes damage, Lanes kept) {
  const Lanes w = law::level(point.r, damage), stiff = law.penalty / (w * line.square), soft = kept * point.r * stiff;
  const Lanes n = select(point.opening.n > Lanes(Real(0)), soft, w * stiff) * point.opening.n, t = soft * point.opening.t;
  return {n * line.z + t * line.x, t * line.z - n * line.x};
}

// Forces of the left side at both ends of edges that are not broken.
INLINE Ends ends_of(Mask whole, Lanes length, const Vector& p, const Vector& q) {
  const Lanes half = Lanes(Real(0.5)) * length, zero(Real(0)), w(law::near), x(law::far);
  const auto end = [&](Lanes near_t, Lanes far_t) __attribute__((always_inline)) {
    return select(whole, half * (w * near_t + x * far_t), zero);
  };
  return {end(p.x, q.x), end(p.z, q.z), end(q.x, p.x), end(q.z, p.z)};
}

// The work that is gone in a step is 1/2 (f0 delta1 - f1 delta0): the trapezoidal work less the growth of what is stored.
INLINE void pull(const View& view, int b, int s, const Edges& edges, LaneSums& gone) {
  const Joint law = law_of(view, view.followed, b);
  const Place at(b, s);
  const Damage damage = load_pair(view.damage + at.pairs), kept = load_pair(view.kept + at.pairs);
  Ends force = ends_of(is_whole(damage), length_of(view.followed, b, s), traction(law, edges.line, edges.p, damage.p, kept.p),
                       traction(law, edges.line, edges.q, damage.q, kept.q));
  const Mask damaged = larger(damage.p, damage.q) > Lanes(Real(0));
  if (any(~damaged)) force = choose(damaged, force, spring_force(spring_of(view, view.followed, b, s), edges.opening));
  const Ends last_force = load_ends(view.force + at.fours), last_opening = load_ends(view.opening + at.fours);
  const Lanes lost = Lanes(Real(0.5)) * (dot(last_force, edges.opening) - dot(force, last_opening));
  gone.part[s] = gone.part[s] + select(damaged, lost, Lanes(Real(0)));
  store_ends(view.opening + at.fours, edges.opening), store_ends(view.force + at.fours, force);
}

// job(block, part, number) for every register of the blocks.
template <class Job>
INLINE void for_each(Blocks blocks, const Job& job) {
  int i = 0;
  for (int b = blocks.begin; b < blocks.end; ++b)
    for (int s = 0; s < parts; ++s) job(b, s, i++);
}

template <class Curve>
INLINE void follow_batch(const View& view, Blocks blocks, LaneSums& gone) {
  Edges edges[batch_blocks * parts];
  int growing[batch_blocks * parts], count = 0;
  for_each(
      blocks, [&](int b, int s, int i) __attribute__((always_inline)) { open(view, b, s, edges[i]); });
  for_each(
      blocks, [&](int b, int s, int i) __attribute__((always_inline)) {
        growing[count] = i;
        count += stretch(view, b, s, edges[i]);
      });
  for (int n = 0; n < count; ++n) {
    const int i = growing[n], b = blocks.begin + i / parts;
    if (soften<Curve>(view, b, i % parts, edges[i])) view.breaks[b] = 1;
  }
  for_each(
      blocks, [&](int b, int s, int i) __attribute__((always_inline)) { pull(view, b, s, edges[i], gone); });
  for_each(
      blocks, [&](int b, int s, int)
                  __attribute__((always_inline)) { store_sides(view, view.followed, b, s, load_ends(view.force + Place(b, s).fours)); });
}

template <class Curve>
INLINE double follow_with(const View& view, Blocks blocks) {
  LaneSums gone;
  for (int b = blocks.begin; b < blocks.end; b += batch_blocks)
    follow_batch<Curve>(view, {b, b + batch_blocks < blocks.end ? b + batch_blocks : blocks.end}, gone);
  return gone.total();
}

}  // namespace

double follow(const View& view, Blocks blocks) {
  return view.curve == Curve::munjiza ? follow_with<law::Munjiza>(view, blocks) : follow_with<law::LinearSoftening>(view, blocks);
}

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
