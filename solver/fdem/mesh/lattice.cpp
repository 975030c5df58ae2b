#include "solver/fdem/mesh/lattice.hpp"

#include <algorithm>
#include <limits>

namespace fracfarm::fdem {
namespace {

__extension__ using Wide = __int128;

constexpr int lattice_bits = 28;  // products of four differences then fit in 128 bits

// The determinant in integers: differences have 29 bits, so it stays below 2^120.
bool in_circle_exact(Point a, Point b, Point c, Point d) {
  const auto lift = [&](Point p) {
    const std::int64_t x = p.x - d.x, z = p.z - d.z;
    return static_cast<Wide>(x * x + z * z);
  };
  const auto cross = [&](Point p, Point q) {
    return static_cast<Wide>(static_cast<std::int64_t>(p.x - d.x) * (q.z - d.z) - static_cast<std::int64_t>(q.x - d.x) * (p.z - d.z));
  };
  return lift(a) * cross(b, c) + lift(b) * cross(c, a) + lift(c) * cross(a, b) > 0;
}

}  // namespace

bool in_circle(Point a, Point b, Point c, Point d) {
  const double ax = a.x - d.x, az = a.z - d.z, bx = b.x - d.x, bz = b.z - d.z, cx = c.x - d.x, cz = c.z - d.z;
  const double bc = bx * cz, cb = cx * bz, ca = cx * az, ac = ax * cz, ab = ax * bz, ba = bx * az;
  const double a2 = ax * ax + az * az, b2 = bx * bx + bz * bz, c2 = cx * cx + cz * cz;
  const double det = a2 * (bc - cb) + b2 * (ca - ac) + c2 * (ab - ba);
  const double size = a2 * (std::fabs(bc) + std::fabs(cb)) + b2 * (std::fabs(ca) + std::fabs(ac)) + c2 * (std::fabs(ab) + std::fabs(ba));
  const double bound = 16 * std::numeric_limits<double>::epsilon() * size;
  if (det > bound) return true;
  if (det < -bound) return false;
  return in_circle_exact(a, b, c, d);
}

Lattice::Lattice(double width, double height, const std::vector<double>& layers) : width_(width) {
  int exponent = 0;
  std::frexp(std::max(width, height), &exponent);
  unit_ = std::ldexp(1.0, exponent - lattice_bits);
  upper_right_ = nearest(width, height);
  for (const double z : layers) heights_[nearest(0.0, z).z] = z;
  heights_[upper_right_.z] = height;
}

double Lattice::z(Point p) const {
  const auto fixed = heights_.find(p.z);
  return fixed == heights_.end() ? p.z * unit_ : fixed->second;
}

std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t z) {
  std::uint32_t index = 0;
  for (std::uint32_t side = 1u << 15; side > 0; side >>= 1) {
    const std::uint32_t right = (x & side) ? 1u : 0u, up = (z & side) ? 1u : 0u;
    index += side * side * ((3u * right) ^ up);
    if (up == 0) {
      if (right == 1) x = 65535u - x, z = 65535u - z;
      std::swap(x, z);
    }
  }
  return index;
}

}  // namespace fracfarm::fdem
