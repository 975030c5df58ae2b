#include "solver/fdem/contact/surface.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace fracfarm::fdem {
namespace {

constexpr int unknown = -1, waiting = -2;
constexpr double notch_angle = 1.5 * std::numbers::pi;  // interior angle from which on a corner is a notch whose sides can close
constexpr double depth_share = 0.25;                    // of the triangle's height: far above what a force that triangles bear can press in
constexpr int most_triangles_around = 100;              // about one corner; more is a broken neighbour table

int next_corner(int k) { return k == 2 ? 0 : k + 1; }
int last_corner(int k) { return k == 0 ? 2 : k - 1; }

struct Point {
  double x, z;
};

Point corner(std::span<const double> corners, int t, int k) {
  const std::size_t at = 8 * static_cast<std::size_t>(t) + 2 * static_cast<std::size_t>(k);
  return {corners[at], corners[at + 1]};
}

double twice_area(std::span<const double> corners, int t) {
  const Point a = corner(corners, t, 0), b = corner(corners, t, 1), c = corner(corners, t, 2);
  return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

// Undeformed angle of triangle t at its corner k.
double angle_at(std::span<const double> corners, int t, int k) {
  const Point a = corner(corners, t, k), b = corner(corners, t, next_corner(k)), c = corner(corners, t, last_corner(k));
  const double cross = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
  const double dot = (b.x - a.x) * (c.x - a.x) + (b.z - a.z) * (c.z - a.z);
  return std::atan2(cross, dot);
}

}  // namespace

Surface::Surface(const std::vector<double>& corners, std::span<const TriangleSide> neighbour)
    : corners_(corners), neighbour_(neighbour), place_(neighbour.size(), unknown) {
  assert(corners.size() / 8 * 3 == neighbour.size());
  const int triangles = static_cast<int>(corners.size() / 8);
  double area = 0.0;
  int real = 0;
  for (int t = 0; t < triangles; ++t) {
    const double own = 0.5 * twice_area(corners, t);
    area += own, real += own > 0.0;
  }
  if (real > 0) mean_length_ = std::sqrt(4.0 / std::numbers::sqrt3 * area / real);
}

void Surface::expose(const Exposure& exposure) {
  const TriangleSide side = exposure.side;
  assert(side >= 0 && static_cast<std::size_t>(side) < place_.size());
  int& place = place_[static_cast<std::size_t>(side)];
  if (place != unknown) return;
  place = waiting;
  pending_.push_back(exposure);
  order_.push_back(exposure);
}

void Surface::clear() {
  order_.clear(), pending_.clear(), sides_.clear(), undeformed_.clear(), rows_.clear();
  std::fill(place_.begin(), place_.end(), unknown);
}

bool Surface::knows(std::span<const Exposure> exposures) const {
  return std::all_of(exposures.begin(), exposures.end(),
                     [&](const Exposure& e) { return e.side >= 0 && static_cast<std::size_t>(e.side) < place_.size(); });
}

void Surface::commit() {
  const std::size_t first = sides_.size();
  for (const Exposure& exposure : pending_) {
    const TriangleSide id = exposure.side;
    const int t = id / 3, k = id % 3;
    const Point a = corner(corners_, t, k), b = corner(corners_, t, next_corner(k));
    ExposedSide side;
    side.id = id, side.triangle = t, side.was_joined = exposure.was_joined != 0;
    rows_.push_back(8 * t + 2 * k);
    undeformed_.push_back({a.x, a.z, b.x, b.z});
    side.force_start = 8 * t + 2 * k, side.force_end = 8 * t + 2 * next_corner(k);
    side.length = std::hypot(b.x - a.x, b.z - a.z);
    side.depth_limit = depth_share * twice_area(corners_, t) / side.length;
    place_[static_cast<std::size_t>(id)] = static_cast<int>(sides_.size());
    sides_.push_back(side);
  }
  pending_.clear();
  for (std::size_t i = first; i < sides_.size(); ++i) link_around(static_cast<int>(i));
}

int Surface::opposite(int place) const {
  const TriangleSide across = neighbour_[static_cast<std::size_t>(sides_[static_cast<std::size_t>(place)].id)];
  return across < 0 ? -1 : this->place(across);
}

bool Surface::same_corner(int u, int v) const {
  const ExposedSide &a = sides_[static_cast<std::size_t>(u)], &b = sides_[static_cast<std::size_t>(v)];
  return a.triangle == b.triangle || (a.next == v && a.joined_end) || (a.previous == v && a.joined_start);
}

void Surface::link(int from, int to, double angle) {
  ExposedSide &a = sides_[static_cast<std::size_t>(from)], &b = sides_[static_cast<std::size_t>(to)];
  a.next = to, b.previous = from;
  a.joined_end = b.joined_start = angle < notch_angle;
}

// Walks about both ends of a side through the triangles that are still bonded, to the exposed sides that come next and before.
void Surface::link_around(int place) {
  const TriangleSide id = sides_[static_cast<std::size_t>(place)].id;
  int t = id / 3, k = next_corner(id % 3);  // about the end: corner k, leaving along side k
  double angle = 0.0;
  for (int n = 0; n < most_triangles_around; ++n) {
    angle += angle_at(corners_, t, k);
    const TriangleSide leaving = 3 * t + k;
    if (const int other = this->place(leaving); other >= 0) {
      link(place, other, angle);
      break;
    }
    const TriangleSide across = neighbour_[static_cast<std::size_t>(leaving)];
    if (across < 0) break;
    t = across / 3, k = next_corner(across % 3);
  }
  t = id / 3, k = id % 3, angle = 0.0;  // about the start: corner k, arriving along side k - 1
  for (int n = 0; n < most_triangles_around; ++n) {
    angle += angle_at(corners_, t, k);
    const TriangleSide arriving = 3 * t + last_corner(k);
    if (const int other = this->place(arriving); other >= 0) {
      link(other, place, angle);
      break;
    }
    const TriangleSide across = neighbour_[static_cast<std::size_t>(arriving)];
    if (across < 0) break;
    t = across / 3, k = across % 3;
  }
}

}  // namespace fracfarm::fdem
