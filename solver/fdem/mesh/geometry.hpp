// Small plane geometry in metres.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/scene/scene.hpp"

namespace fracfarm::fdem {

struct Vec {
  double x = 0.0, z = 0.0;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.z + b.z}; }
  friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.z - b.z}; }
  friend Vec operator*(double s, Vec a) { return {s * a.x, s * a.z}; }
};

inline double dot(Vec a, Vec b) { return a.x * b.x + a.z * b.z; }
inline double cross(Vec a, Vec b) { return a.x * b.z - a.z * b.x; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline double distance(Vec a, Vec b) { return length(b - a); }

inline Vec first(const Segment& s) { return {s.x0, s.z0}; }
inline Vec last(const Segment& s) { return {s.x1, s.z1}; }
inline double length(const Segment& s) { return distance(first(s), last(s)); }

// Share of the way from a to b where p's foot lies, not cut to 0 ... 1; 0 where a and b are one point.
inline double foot_share(Vec p, Vec a, Vec b) {
  const double square = dot(b - a, b - a);
  return square > 0 ? dot(p - a, b - a) / square : 0.0;
}
inline Vec along(Vec a, Vec b, double share) { return a + share * (b - a); }
inline Vec nearest_on(Vec p, Vec a, Vec b) { return along(a, b, std::clamp(foot_share(p, a, b), 0.0, 1.0)); }
inline double distance_to(Vec p, Vec a, Vec b) { return distance(p, nearest_on(p, a, b)); }

// Shares of a -> b and c -> d where their lines meet; none where they are parallel to rounding.
struct Meeting {
  double first, second;
};
inline std::optional<Meeting> meeting(Vec a, Vec b, Vec c, Vec d) {
  const Vec u = b - a, v = d - c;
  const double turn = cross(u, v);
  if (std::fabs(turn) <= 1e-12 * length(u) * length(v)) return std::nullopt;
  return Meeting{cross(c - a, v) / turn, cross(c - a, u) / turn};
}

}  // namespace fracfarm::fdem
