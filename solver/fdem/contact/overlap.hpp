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
// quarter of `margin`? False only where that is impossible; false, too, where a coordinate is no number. Lengths below are times that of
// the side, so that nothing is divided.
inline bool may_touch(const SideNow& target, const SideNow& side, double depth_limit, double margin) {
  const double ex = side.bx - side.ax, ez = side.bz - side.az, square = ex * ex + ez * ez, length = std::sqrt(square);
  const PlanePoint p = point_on(target, point_place.front()), q = point_on(target, point_place.back());
  const double px = p.x - side.ax, pz = p.z - side.az, qx = q.x - side.ax, qz = q.z - side.az;
  const double p_depth = ex * pz - ez * px, q_depth = ex * qz - ez * qx;
  const double deepest = std::max(p_depth, q_depth), highest = std::min(p_depth, q_depth);
  if (!(deepest > -margin * length && highest < (depth_limit + margin) * length)) return false;
  const double p_along = ex * px + ez * pz, q_along = ex * qx + ez * qz, reach = 2.0 * margin * length, most = reach + depth_limit * length;
  return std::min(p_along, q_along) < square + most && std::max(p_along, q_along) > -most &&
         std::min(p_along - p_depth, q_along - q_depth) < square + reach &&  // a mitre reaches out as far as it is deep
         std::max(p_along + p_depth, q_along + q_depth) > -reach;
}

}  // namespace fracfarm::fdem
