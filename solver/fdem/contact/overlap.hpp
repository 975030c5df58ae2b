// Where a point of one exposed side lies with respect to another exposed side, in the deformed state. Pure geometry, in double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace fracfarm::fdem {

// Ends of a side now, m.
struct SideNow {
  double ax = 0, az = 0, bx = 0, bz = 0;
};

// Three Gauss points on a side: place from its start, weight; both as shares of its length. Exact for a depth that is linear along the
// side.
inline constexpr std::array<double, 3> point_place{0.11270166537925831, 0.5, 0.88729833462074169};
inline constexpr std::array<double, 3> point_weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

struct PlanePoint {
  double x, z;
};

inline PlanePoint point_on(const SideNow& side, double place) {
  return {side.ax + place * (side.bx - side.ax), side.az + place * (side.bz - side.az)};
}

// A side's own axes: t along it, n = (-t_z, t_x) into the triangle.
struct Axes {
  double tx, tz, length;
};

inline Axes axes(const SideNow& side) {
  const double ex = side.bx - side.ax, ez = side.bz - side.az, length = std::sqrt(ex * ex + ez * ez);
  return {ex / length, ez / length, length};
}

struct Place {
  double along;  // m from the start
  double depth;  // m into the triangle, below the side's line
};

inline Place place_of(const PlanePoint& p, const SideNow& side, const Axes& a) {
  const double x = p.x - side.ax, z = p.z - side.az;
  return {a.tx * x + a.tz * z, a.tx * z - a.tz * x};
}

// May a point of `target` between its outer Gauss points be in contact with `side`, or be after none of their corners moved further than a
// quarter of `margin`? False only where that is impossible; false, too, where a coordinate is no number.
inline bool may_touch(const SideNow& target, const SideNow& side, double depth_limit, double margin) {
  const Axes a = axes(side);
  const Place p = place_of(point_on(target, point_place.front()), side, a), q = place_of(point_on(target, point_place.back()), side, a);
  const double deepest = std::max(p.depth, q.depth), highest = std::min(p.depth, q.depth);
  if (!(deepest > -margin && highest < depth_limit + margin)) return false;
  const double beyond = 2.0 * margin + std::clamp(deepest, 0.0, depth_limit);  // a mitre reaches as far beyond the end as it is deep
  return std::min(p.along, q.along) < a.length + beyond && std::max(p.along, q.along) > -beyond;
}

}  // namespace fracfarm::fdem
