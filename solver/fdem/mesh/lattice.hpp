// The lattice that mesh points live on: whole multiples of a power of two of a metre, at most 2^28 of them across. Orientation and circle
// tests are then exact, and the same points give the same triangles on any host.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace fracfarm::fdem {

struct Point {
  std::int32_t x = 0, z = 0;
  bool operator==(const Point&) const = default;
};

// Twice the signed area of a triangle, positive counter-clockwise. Exact.
inline std::int64_t orientation(Point a, Point b, Point c) {
  return static_cast<std::int64_t>(b.x - a.x) * (c.z - a.z) - static_cast<std::int64_t>(b.z - a.z) * (c.x - a.x);
}

// Is d strictly inside the circle through the counter-clockwise a, b, c? Exact: doubles where their error cannot change the sign, else
// 128-bit integers (J. R. Shewchuk, Adaptive precision floating-point arithmetic, 1997, for the bound).
bool in_circle(Point a, Point b, Point c, Point d);

inline double distance_squared(Point a, Point b) {
  const double dx = a.x - b.x, dz = a.z - b.z;
  return dx * dx + dz * dz;
}

// Between metres and lattice points: lines that must stay where they are (sides, layers) come back to the bit.
class Lattice {
 public:
  Lattice(double width, double height, const std::vector<double>& layers);

  double unit() const { return unit_; }  // m
  Point upper_right() const { return upper_right_; }
  Point nearest(double x, double z) const {
    return {static_cast<std::int32_t>(std::lround(x / unit_)), static_cast<std::int32_t>(std::lround(z / unit_))};
  }
  double x(Point p) const { return p.x == upper_right_.x ? width_ : p.x * unit_; }  // m
  double z(Point p) const;

 private:
  double unit_, width_;
  Point upper_right_;
  std::map<std::int32_t, double> heights_;  // of the layers and the top
};

// Place along the Hilbert curve through a square of 2^16 cells a side; x and z below 2^16.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t z);

}  // namespace fracfarm::fdem
