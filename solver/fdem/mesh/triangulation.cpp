// Incremental insertion with Lawson flips (C. L. Lawson, 1977); edges are demanded by S. W. Sloan's swaps (1993).
#include "solver/fdem/mesh/triangulation.hpp"

#include <cassert>
#include <cstddef>
#include <tuple>

namespace fracfarm::fdem {
namespace {

constexpr int next(int k) { return k == 2 ? 0 : k + 1; }
constexpr int previous(int k) { return k == 0 ? 2 : k - 1; }

}  // namespace

Triangulation::Triangulation(Point upper_right) {
  points_ = {{0, 0}, {upper_right.x, 0}, upper_right, {0, upper_right.z}};
  triangles_ = {Triangle{{0, 1, 2}, {-1, 1, -1}, {}}, Triangle{{0, 2, 3}, {-1, -1, 0}, {}}};
  triangle_of_ = {0, 0, 0, 1};
}

int Triangulation::place_of(int t, int neighbour) const {
  const Triangle& it = triangle(t);
  return it.across[0] == neighbour ? 0 : it.across[1] == neighbour ? 1 : 2;
}

int Triangulation::add_triangle(const Triangle& made) {
  triangles_.push_back(made);
  return static_cast<int>(triangles_.size()) - 1;
}

void Triangulation::set_neighbour(int t, int from, int to) {
  if (t >= 0) triangle(t).across[static_cast<std::size_t>(place_of(t, from))] = to;
}

// Walks towards p over edges that have it on their far side; ends in a Delaunay triangulation, and the cap guards the constrained one.
std::pair<int, int> Triangulation::locate(Point p, int near) const {
  int t = near, came_from = -1;
  for (std::size_t step = 0, most = 4 * triangles_.size() + 16; step < most; ++step) {
    const Triangle& it = triangle(t);
    int on = -1, go = -1;
    for (int k = 0; k < 3 && go < 0; ++k) {
      const int i = (k + static_cast<int>(step % 3)) % 3;
      if (it.across[i] == came_from && came_from >= 0) continue;
      const std::int64_t side = orientation(at(it.corner[next(i)]), at(it.corner[previous(i)]), p);
      if (side < 0) go = i;
      if (side == 0) on = i;
    }
    if (go < 0) return {t, on};
    came_from = t;
    t = it.across[go];
    assert(t >= 0 && "the point lies outside the rectangle");
  }
  for (int all = 0; all < static_cast<int>(triangles_.size()); ++all) {  // never needed so far
    const Triangle& it = triangle(all);
    int on = -1;
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t side = orientation(at(it.corner[next(i)]), at(it.corner[previous(i)]), p);
      inside = inside && side >= 0;
      if (side == 0) on = i;
    }
    if (inside) return {all, on};
  }
  return {-1, -1};
}

int Triangulation::locate_in_sight(Point p, int from) const {
  int t = from, came_from = -1;
  for (std::size_t step = 0; step < 64; ++step) {
    const Triangle& it = triangle(t);
    int go = -1;
    for (int i = 0; i < 3 && go < 0; ++i)
      if ((it.across[i] != came_from || came_from < 0) && orientation(at(it.corner[next(i)]), at(it.corner[previous(i)]), p) < 0) go = i;
    if (go < 0) return t;
    if (it.constrained[go] || it.across[go] < 0) return -1;
    came_from = t;
    t = it.across[go];
  }
  return -1;
}

int Triangulation::insert(Point p, int near) {
  const auto [t, on] = locate(p, near);
  assert(t >= 0);
  for (const int corner : triangle(t).corner)
    if (at(corner) == p) return corner;
  const int point = static_cast<int>(points_.size());
  points_.push_back(p);
  triangle_of_.push_back(t);
  stack_.clear();
  if (on < 0)
    split_inside(t, point);
  else
    split_edge(t, on, point);
  legalise();
  return point;
}

// a b c around the point: a b p stays in place, b c p and c a p are new. The new point is corner 0 of each.
void Triangulation::split_inside(int t, int point) {
  const Triangle old = triangle(t);
  const auto [a, b, c] = old.corner;
  const int second = static_cast<int>(triangles_.size()), third = second + 1;
  triangle(t) = {{point, a, b}, {old.across[2], second, third}, {old.constrained[2], 0, 0}};
  add_triangle({{point, b, c}, {old.across[0], third, t}, {old.constrained[0], 0, 0}});
  add_triangle({{point, c, a}, {old.across[1], t, second}, {old.constrained[1], 0, 0}});
  set_neighbour(old.across[0], t, second);
  set_neighbour(old.across[1], t, third);
  triangle_of_[static_cast<std::size_t>(c)] = second;
  triangle_of_[static_cast<std::size_t>(a)] = t;
  triangle_of_[static_cast<std::size_t>(b)] = t;
  stack_ = {t, second, third};
}

// The point lies on the edge a -> b of t = (p, a, b) with p its corner k; each triangle at that edge becomes two.
void Triangulation::split_edge(int t, int k, int point) {
  const Triangle old = triangle(t);
  const int apex = old.corner[k], a = old.corner[next(k)], b = old.corner[previous(k)], other = old.across[k];
  const unsigned char stays = old.constrained[k];
  const int half = static_cast<int>(triangles_.size());
  const int far_half = other >= 0 ? half + 1 : -1;
  triangle(t) = {{point, apex, a}, {old.across[previous(k)], other, half}, {old.constrained[previous(k)], stays, 0}};
  add_triangle({{point, b, apex}, {old.across[next(k)], t, far_half}, {old.constrained[next(k)], 0, stays}});
  set_neighbour(old.across[next(k)], t, half);
  triangle_of_[static_cast<std::size_t>(a)] = t;
  triangle_of_[static_cast<std::size_t>(apex)] = t;
  triangle_of_[static_cast<std::size_t>(b)] = half;
  stack_ = {t, half};
  if (other < 0) return;
  const Triangle beyond = triangle(other);
  const int j = beyond.across[0] == t ? 0 : beyond.across[1] == t ? 1 : 2;
  const int far = beyond.corner[j];  // beyond = (far, b, a)
  triangle(other) = {{point, a, far}, {beyond.across[next(j)], far_half, t}, {beyond.constrained[next(j)], 0, stays}};
  add_triangle({{point, far, b}, {beyond.across[previous(j)], half, other}, {beyond.constrained[previous(j)], stays, 0}});
  set_neighbour(beyond.across[previous(j)], other, far_half);
  triangle_of_[static_cast<std::size_t>(far)] = other;
  stack_.push_back(other);
  stack_.push_back(far_half);
}

bool Triangulation::illegal(int t, int k) const {
  const Triangle& it = triangle(t);
  const int other = it.across[k];
  if (other < 0 || it.constrained[k]) return false;
  const int far = triangle(other).corner[place_of(other, t)];
  return in_circle(at(it.corner[0]), at(it.corner[1]), at(it.corner[2]), at(far));
}

void Triangulation::legalise() {
  while (!stack_.empty()) {
    const int t = stack_.back();
    stack_.pop_back();
    if (!illegal(t, 0)) continue;
    const int other = triangle(t).across[0];
    flip(t, 0);
    stack_.push_back(t);
    stack_.push_back(other);
  }
}

bool Triangulation::flippable(int t, int k) const {
  const Triangle& it = triangle(t);
  const int other = it.across[k];
  if (other < 0 || it.constrained[k]) return false;
  const Point p = at(it.corner[k]), a = at(it.corner[next(k)]), b = at(it.corner[previous(k)]);
  const Point q = at(triangle(other).corner[place_of(other, t)]);
  return orientation(p, a, q) > 0 && orientation(p, q, b) > 0;
}

// t = (p, a, b), other = (q, b, a): they become (p, a, q) and (p, q, b).
void Triangulation::flip(int t, int k) {
  const Triangle old = triangle(t);
  const int other = old.across[k];
  const Triangle beyond = triangle(other);
  const int j = beyond.across[0] == t ? 0 : beyond.across[1] == t ? 1 : 2;
  const int p = old.corner[k], a = old.corner[next(k)], b = old.corner[previous(k)], q = beyond.corner[j];
  const int bp = old.across[next(k)], pa = old.across[previous(k)], aq = beyond.across[next(j)], qb = beyond.across[previous(j)];
  triangle(t) = {{p, a, q}, {aq, other, pa}, {beyond.constrained[next(j)], 0, old.constrained[previous(k)]}};
  triangle(other) = {{p, q, b}, {qb, bp, t}, {beyond.constrained[previous(j)], old.constrained[next(k)], 0}};
  set_neighbour(aq, other, t);
  set_neighbour(bp, t, other);
  triangle_of_[static_cast<std::size_t>(p)] = t;
  triangle_of_[static_cast<std::size_t>(a)] = t;
  triangle_of_[static_cast<std::size_t>(b)] = other;
  triangle_of_[static_cast<std::size_t>(q)] = t;
}

bool Triangulation::restore() {
  stack_.clear();
  const int count = static_cast<int>(triangles_.size());
  for (int t = 0; t < count; ++t)
    for (int k = 0; k < 3; ++k)
      if (triangle(t).across[k] > t && illegal(t, k)) {
        stack_.push_back(t);
        break;
      }
  std::size_t flips = 0;
  while (!stack_.empty()) {
    const int t = stack_.back();
    stack_.pop_back();
    for (int k = 0; k < 3; ++k) {
      if (!illegal(t, k)) continue;
      const int other = triangle(t).across[k];
      flip(t, k);
      stack_.push_back(t);
      stack_.push_back(other);
      if (++flips > 1000 * triangles_.size()) return false;
      break;
    }
  }
  return true;
}

bool Triangulation::star(int point, std::vector<std::pair<int, int>>& star) const {
  star.clear();
  const int first = triangle_of(point);
  int t = first;
  do {
    const Triangle& it = triangle(t);
    const int k = it.corner[0] == point ? 0 : it.corner[1] == point ? 1 : 2;
    star.emplace_back(t, k);
    t = it.across[next(k)];  // over the edge from the last corner back to the point
    if (t < 0) return false;
  } while (t != first);
  return true;
}

std::pair<int, int> Triangulation::edge(int a, int b) const {
  const int first = triangle_of(a);
  for (const bool backwards : {false, true}) {
    int t = first;
    do {
      const Triangle& it = triangle(t);
      const int k = it.corner[0] == a ? 0 : it.corner[1] == a ? 1 : 2;
      if (it.corner[next(k)] == b) return {t, previous(k)};
      t = backwards ? it.across[previous(k)] : it.across[next(k)];
    } while (t >= 0 && t != first);
    if (t == first) break;  // a full turn
  }
  return {-1, -1};
}

// Edges that the way from a to b crosses, as pairs (right, left) of points. False where the way meets a point or a constrained edge.
bool Triangulation::crossing_edges(int a, int b, std::vector<std::pair<int, int>>& crossed) const {
  const Point from = at(a), to = at(b);
  int t = -1, k = -1;
  for (const bool backwards : {false, true}) {
    int turn = triangle_of(a);
    do {
      const Triangle& it = triangle(turn);
      const int i = it.corner[0] == a ? 0 : it.corner[1] == a ? 1 : 2;
      if (orientation(from, to, at(it.corner[next(i)])) < 0 && orientation(from, to, at(it.corner[previous(i)])) > 0 &&
          orientation(at(it.corner[next(i)]), at(it.corner[previous(i)]), to) < 0)
        t = turn, k = i;
      turn = backwards ? it.across[previous(i)] : it.across[next(i)];
    } while (t < 0 && turn >= 0 && turn != triangle_of(a));
    if (t >= 0) break;
  }
  if (t < 0) return false;
  for (;;) {
    const Triangle& it = triangle(t);
    if (it.constrained[k] || it.across[k] < 0) return false;
    crossed.emplace_back(it.corner[next(k)], it.corner[previous(k)]);
    const int other = it.across[k], j = place_of(other, t);
    const int far = triangle(other).corner[j];
    if (far == b) return true;
    const std::int64_t side = orientation(from, to, at(far));
    if (side == 0) return false;
    t = other;
    k = side > 0 ? next(j) : previous(j);  // far lies left: leave between it and the right point, which is the corner after the next
    if (crossed.size() > triangles_.size()) return false;
  }
}

bool Triangulation::constrain(int a, int b) {
  std::vector<std::pair<int, int>> crossed;
  if (edge(a, b).first < 0 && edge(b, a).first < 0 && !crossing_edges(a, b, crossed)) return false;
  const Point from = at(a), to = at(b);
  std::size_t tries = 0;
  for (std::size_t i = 0; i < crossed.size(); ++i) {  // edges that cannot be flipped yet, or cross again, go to the back
    if (++tries > 100 + 100 * crossed.size()) return false;
    auto [t, k] = edge(crossed[i].first, crossed[i].second);
    if (t < 0) std::tie(t, k) = edge(crossed[i].second, crossed[i].first);
    if (t < 0) return false;
    if (!flippable(t, k)) {
      crossed.push_back(crossed[i]);
      continue;
    }
    const int p = triangle(t).corner[k], other = triangle(t).across[k], q = triangle(other).corner[place_of(other, t)];
    flip(t, k);
    const std::int64_t side_p = orientation(from, to, at(p)), side_q = orientation(from, to, at(q));
    if (p != a && p != b && q != a && q != b && (side_p > 0) != (side_q > 0)) crossed.emplace_back(p, q);
  }
  for (const auto& [first, second] : {std::pair{a, b}, std::pair{b, a}}) {
    const auto [t, k] = edge(first, second);
    if (t >= 0) triangle(t).constrained[k] = 1;
  }
  return edge(a, b).first >= 0 || edge(b, a).first >= 0;
}

}  // namespace fracfarm::fdem
