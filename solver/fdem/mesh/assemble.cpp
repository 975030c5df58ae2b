#include "solver/fdem/mesh/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "solver/fdem/mesh/lattice.hpp"

namespace fracfarm::fdem {
namespace {

// Triangles by the place of their centres on a Hilbert curve through the smallest square over all nodes.
std::vector<int> hilbert_order(const Soup& soup) {
  std::array<double, 2> low = soup.nodes.front(), high = low;
  for (const auto& node : soup.nodes)
    for (std::size_t axis = 0; axis < 2; ++axis) low[axis] = std::min(low[axis], node[axis]), high[axis] = std::max(high[axis], node[axis]);
  const double scale = 65535.0 / std::max({high[0] - low[0], high[1] - low[1], 1e-300});
  std::vector<std::uint64_t> keys;
  keys.reserve(soup.triangles.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    std::array<std::uint32_t, 2> cell{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double sum = 0.0;
      for (const int node : soup.triangles[t]) sum += soup.nodes[static_cast<std::size_t>(node)][axis] - low[axis];
      cell[axis] = static_cast<std::uint32_t>(std::clamp(sum / 3 * scale, 0.0, 65535.0));
    }
    keys.push_back(static_cast<std::uint64_t>(hilbert_index(cell[0], cell[1])) << 32 | t);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  order.reserve(keys.size());
  for (const std::uint64_t key : keys) order.push_back(static_cast<int>(key & 0xffffffffu));
  return order;
}

// Edges by their lower node, in the order of their first triangle.
class EdgeTable {
 public:
  struct Edge {
    std::array<int, 2> nodes{}, triangles{-1, -1};
    int next = -1;  // with the same lower node
  };

  explicit EdgeTable(std::size_t nodes) : head_(nodes, -1) {}

  int find(int a, int b) const {
    for (int e = head_[static_cast<std::size_t>(std::min(a, b))]; e >= 0; e = edges_[static_cast<std::size_t>(e)].next) {
      const Edge& edge = edges_[static_cast<std::size_t>(e)];
      if ((edge.nodes[0] == a && edge.nodes[1] == b) || (edge.nodes[0] == b && edge.nodes[1] == a)) return e;
    }
    return -1;
  }

  // Triangle t has the edge a -> b on its boundary. False where that way has a triangle already.
  bool touch(int a, int b, int t) {
    const int there = find(a, b);
    if (there < 0) {
      int& head = head_[static_cast<std::size_t>(std::min(a, b))];
      edges_.push_back({{a, b}, {t, -1}, head});
      head = static_cast<int>(edges_.size()) - 1;
      return true;
    }
    Edge& edge = edges_[static_cast<std::size_t>(there)];
    if (edge.triangles[1] >= 0 || edge.nodes[0] == a) return false;
    edge.triangles[1] = t;
    return true;
  }

  const std::vector<Edge>& edges() const { return edges_; }

 private:
  std::vector<int> head_;
  std::vector<Edge> edges_;
};

std::string place_text(const std::array<double, 2>& node) { return fmt::format("({:.6g}, {:.6g}) m", node[0], node[1]); }

// New numbers of the soup's nodes; -1 for those that no triangle has.
std::vector<int> number_nodes(const Soup& soup, const std::vector<int>& order, TriangleMesh& mesh) {
  std::vector<int> number(soup.nodes.size(), -1);
  mesh.nodes.reserve(soup.nodes.size());
  mesh.triangles.reserve(order.size());
  for (const int t : order) {
    std::array<int, 3> corners = soup.triangles[static_cast<std::size_t>(t)];
    for (int& corner : corners) {
      int& mine = number[static_cast<std::size_t>(corner)];
      if (mine < 0) {
        mine = static_cast<int>(mesh.nodes.size());
        mesh.nodes.push_back(soup.nodes[static_cast<std::size_t>(corner)]);
      }
      corner = mine;
    }
    mesh.triangles.push_back(corners);
  }
  return number;
}

}  // namespace

tl::expected<TriangleMesh, std::string> assemble(const Soup& soup) {
  TriangleMesh mesh;
  if (soup.triangles.empty()) return tl::unexpected(std::string("the mesh has no triangle"));
  const std::vector<int> number = number_nodes(soup, hilbert_order(soup), mesh);
  if (const auto unused = std::find(number.begin(), number.end(), -1); unused != number.end())
    return tl::unexpected("the node at " + place_text(soup.nodes[static_cast<std::size_t>(unused - number.begin())]) + " has no triangle");
  EdgeTable table(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (!table.touch(a, b, static_cast<int>(t)))
        return tl::unexpected("two triangles overlap at the edge from " + place_text(mesh.nodes[static_cast<std::size_t>(a)]) + " to " +
                              place_text(mesh.nodes[static_cast<std::size_t>(b)]));
    }
  std::vector<int> inner(table.edges().size(), -1);
  for (std::size_t e = 0; e < inner.size(); ++e) {
    const EdgeTable::Edge& edge = table.edges()[e];
    if (edge.triangles[1] < 0) continue;
    inner[e] = static_cast<int>(mesh.edge_nodes.size());
    mesh.edge_nodes.push_back(edge.nodes);
    mesh.edge_triangles.push_back(edge.triangles);
  }
  mesh.edge_kind.assign(mesh.edge_nodes.size(), EdgeKind::joint);
  for (const auto& [a, b] : soup.crack_edges) {
    const int e = table.find(number[static_cast<std::size_t>(a)], number[static_cast<std::size_t>(b)]);
    if (e < 0)
      return tl::unexpected("the crack edge from " + place_text(soup.nodes[static_cast<std::size_t>(a)]) + " to " +
                            place_text(soup.nodes[static_cast<std::size_t>(b)]) + " is missing");
    if (inner[static_cast<std::size_t>(e)] >= 0)
      mesh.edge_kind[static_cast<std::size_t>(inner[static_cast<std::size_t>(e)])] = EdgeKind::crack;
  }
  return mesh;
}

std::vector<std::pair<int, int>> outline_of(const TriangleMesh& mesh) {
  EdgeTable table(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) table.touch(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], static_cast<int>(t));
  std::vector<std::pair<int, int>> outline;
  for (const EdgeTable::Edge& edge : table.edges())
    if (edge.triangles[1] < 0) outline.emplace_back(edge.nodes[0], edge.nodes[1]);
  return outline;
}

}  // namespace fracfarm::fdem
