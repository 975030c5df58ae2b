// A user's mesh: held against the scene's body, layers and cracks, then through the mesher's own gate.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/base/clock.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/assemble.hpp"
#include "solver/fdem/mesh/gate.hpp"
#include "solver/fdem/mesh/geometry.hpp"
#include "solver/fdem/mesh/msh_text.hpp"
#include "solver/fdem/mesh/repair.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double on_line_share = 1e-3;  // of the element size: a node nearer than this lies on a side, a layer or a crack

MeshResult refuse(std::string reason) { return tl::unexpected<std::string>(std::move(reason)); }

// Nodes of triangles alone, in the file's order: what else a file holds (centres of arcs, say) is no part of the mesh.
void drop_unused(MshContent& content) {
  std::vector<int> number(content.nodes.size(), -1);
  for (const auto& triangle : content.triangles)
    for (const int node : triangle) number[static_cast<std::size_t>(node)] = 0;
  int next = 0;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == 0) {
      content.nodes[static_cast<std::size_t>(next)] = content.nodes[i];
      number[i] = next++;
    }
  content.nodes.resize(static_cast<std::size_t>(next));
  for (auto& triangle : content.triangles)
    for (int& node : triangle) node = number[static_cast<std::size_t>(node)];
  for (auto& [a, b] : content.crack_edges) a = number[static_cast<std::size_t>(a)], b = number[static_cast<std::size_t>(b)];
  std::erase_if(content.crack_edges, [](const auto& edge) { return edge.first < 0 || edge.second < 0; });
}

double snapped(double value, double end, double tolerance) {
  if (std::fabs(value) < tolerance) return 0.0;
  return std::fabs(value - end) < tolerance ? end : value;
}

// x and y of the file are x and z of the body; nodes beside a side by rounding lie on it. Says what does not fit the body.
std::string take_nodes(const MshContent& content, const MeshChoice& choice, Soup& soup) {
  const double tolerance = on_line_share * choice.element_size;
  for (const auto& [x, y, out_of_plane] : content.nodes) {
    if (std::fabs(out_of_plane) > tolerance)
      return fmt::format("a node lies at z = {} m of the file; the body is its plane z = 0", out_of_plane);
    soup.nodes.push_back({snapped(x, choice.width, tolerance), snapped(y, choice.height, tolerance)});
    const auto& [px, pz] = soup.nodes.back();
    if (px < 0 || px > choice.width || pz < 0 || pz > choice.height)
      return fmt::format("the node at ({}, {}) m lies outside the body of {} x {} m", x, y, choice.width, choice.height);
  }
  std::vector<std::array<double, 2>> places = soup.nodes;
  std::sort(places.begin(), places.end());
  if (const auto twin = std::adjacent_find(places.begin(), places.end()); twin != places.end())
    return fmt::format("two nodes lie at ({}, {}) m; triangles must share their nodes", (*twin)[0], (*twin)[1]);
  return {};
}

void take_triangles(const MshContent& content, Soup& soup) {
  for (std::array<int, 3> triangle : content.triangles) {
    const auto at = [&](std::size_t k) {
      const auto& node = soup.nodes[static_cast<std::size_t>(triangle[k])];
      return Vec{node[0], node[1]};
    };
    if (cross(at(1) - at(0), at(2) - at(0)) < 0) std::swap(triangle[1], triangle[2]);
    soup.triangles.push_back(triangle);
  }
}

std::string mixed_layer(const Soup& soup, const MeshChoice& choice) {
  const double tolerance = on_line_share * choice.element_size;
  for (const double layer : choice.layers)
    for (const auto& triangle : soup.triangles) {
      bool above = false, below = false;
      for (const int node : triangle) {
        const double z = soup.nodes[static_cast<std::size_t>(node)][1];
        above = above || z > layer + tolerance;
        below = below || z < layer - tolerance;
      }
      if (above && below) return fmt::format("a triangle lies on both sides of the layer boundary at {} m", layer);
    }
  return {};
}

Vec node(const TriangleMesh& mesh, int i) {
  return {mesh.nodes[static_cast<std::size_t>(i)][0], mesh.nodes[static_cast<std::size_t>(i)][1]};
}

// Where the file names no crack edges: those that lie on a crack of the scene.
void mark_cracks(TriangleMesh& mesh, const std::vector<Segment>& cracks, double tolerance) {
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    const Vec p = node(mesh, mesh.edge_nodes[e][0]), q = node(mesh, mesh.edge_nodes[e][1]);
    for (const Segment& crack : cracks)
      if (distance_to(p, first(crack), last(crack)) < tolerance && distance_to(q, first(crack), last(crack)) < tolerance)
        mesh.edge_kind[e] = EdgeKind::crack;
  }
}

MeshResult from_msh(std::string_view bytes, const MeshChoice& choice) {
  if (std::string reason = refusal_of_numbers(choice); !reason.empty()) return refuse(std::move(reason));
  auto content = parse_msh(bytes);
  if (!content) return refuse("the mesh file: " + content.error());
  drop_unused(*content);
  Soup soup;
  if (std::string reason = take_nodes(*content, choice, soup); !reason.empty()) return refuse(std::move(reason));
  take_triangles(*content, soup);
  soup.crack_edges = content->crack_edges;
  if (std::string reason = mixed_layer(soup, choice); !reason.empty()) return refuse(std::move(reason));
  auto mesh = assemble(soup);
  if (!mesh) return refuse(mesh.error());
  MadeMesh made{std::move(*mesh), {}, {}};
  for (Segment crack : choice.cracks)
    if (clip(crack, choice.width, choice.height)) made.cracks.push_back(crack);
  if (!content->names_cracks) mark_cracks(made.mesh, made.cracks, on_line_share * choice.element_size);
  if (std::string reason = gate(made.mesh, choice, made.report); !reason.empty()) return refuse(std::move(reason));
  const double reach = content->names_cracks ? choice.element_size : 2 * on_line_share * choice.element_size;
  if (std::string reason = strayed_crack(made.mesh, choice, reach); !reason.empty()) return refuse(std::move(reason));
  return made;
}

}  // namespace

MeshResult read_msh(std::string_view bytes, const MeshChoice& choice) {
  SystemClock clock;
  const double start = clock.monotonic_s();
  MeshResult made = from_msh(bytes, choice);
  if (made) made->report.seconds = clock.monotonic_s() - start;
  return made;
}

}  // namespace fracfarm::fdem
