#include "solver/fdem/order.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace fracfarm::fdem {
namespace {

constexpr int bits = 16;  // of each coordinate

// Distance along the Hilbert curve of order `bits` (Warren, Hacker's Delight, 16-1).
std::uint64_t along_hilbert(std::uint32_t x, std::uint32_t z) {
  std::uint64_t distance = 0;
  for (std::uint32_t s = 1U << (bits - 1); s > 0; s /= 2) {
    const std::uint32_t right = (x & s) > 0, upper = (z & s) > 0;
    distance += std::uint64_t{s} * s * ((3 * right) ^ upper);
    if (!upper) {
      if (right) x = s - 1 - (x & (s - 1)), z = s - 1 - (z & (s - 1));
      std::swap(x, z);
    }
    x &= s - 1, z &= s - 1;
  }
  return distance;
}

struct Box {
  double x = 1e300, z = 1e300, size = 0.0;
};

Box box_of(const TriangleMesh& mesh) {
  Box box;
  double x = -1e300, z = -1e300;
  for (const auto& node : mesh.nodes) box.x = std::min(box.x, node[0]), box.z = std::min(box.z, node[1]);
  for (const auto& node : mesh.nodes) x = std::max(x, node[0]), z = std::max(z, node[1]);
  box.size = std::max({x - box.x, z - box.z, 1e-300});
  return box;
}

}  // namespace

std::vector<int> triangle_order(const Body& body, int block) {
  const TriangleMesh& mesh = body.mesh;
  const Box box = box_of(mesh);
  const double scale = ((1U << bits) - 1) / (3.0 * box.size);
  std::vector<std::uint64_t> key;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
    const double x = at(a)[0] + at(b)[0] + at(c)[0] - 3 * box.x, z = at(a)[1] + at(b)[1] + at(c)[1] - 3 * box.z;
    key.push_back(along_hilbert(static_cast<std::uint32_t>(x * scale), static_cast<std::uint32_t>(z * scale)));
  }
  const auto material = [&](int t) { return body.material_of.empty() ? 0 : body.material_of[static_cast<std::size_t>(t)]; };
  std::vector<int> sorted(mesh.triangles.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](int s, int t) {
    return std::pair(material(s), key[static_cast<std::size_t>(s)]) < std::pair(material(t), key[static_cast<std::size_t>(t)]);
  });
  std::vector<int> order;
  const auto fill = [&] {
    order.resize((order.size() + static_cast<std::size_t>(block) - 1) / static_cast<std::size_t>(block) * static_cast<std::size_t>(block),
                 -1);
  };
  for (const int t : sorted) {
    if (!order.empty() && order.back() >= 0 && material(order.back()) != material(t)) fill();
    order.push_back(t);
  }
  fill();
  return order;
}

}  // namespace fracfarm::fdem
