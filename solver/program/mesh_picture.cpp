#include "solver/program/mesh_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fracfarm {
namespace {

using namespace picture;

constexpr int margin = 24, caption = 64;
constexpr double longer_side = 1500.0;  // pixels
constexpr Colour edge_colour{150, 158, 170}, side_colour{40, 44, 52}, crack_colour{196, 30, 46}, layer_colour{30, 110, 200},
    flat_colour{255, 170, 0};

// From metres to pixels.
struct View {
  double scale, height;
  double x(double metres) const { return margin + scale * metres; }
  double y(double metres) const { return margin + scale * (height - metres); }
};

void draw_edge(Canvas& canvas, const View& view, const TriangleMesh& mesh, int a, int b, Colour colour, double thickness) {
  const auto &p = mesh.nodes[static_cast<std::size_t>(a)], &q = mesh.nodes[static_cast<std::size_t>(b)];
  canvas.line(view.x(p[0]), view.y(p[1]), view.x(q[0]), view.y(q[1]), colour, thickness);
}

double height_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto at = [&](int k) { return mesh.nodes[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])]; };
  double longest = 0.0, twice = 0.0;
  for (int k = 0; k < 3; ++k) {
    const auto p = at(k), q = at((k + 1) % 3);
    longest = std::max(longest, std::hypot(q[0] - p[0], q[1] - p[1]));
    twice += p[0] * q[1] - q[0] * p[1];
  }
  return twice / longest;
}

void draw_flattest(Canvas& canvas, const View& view, const TriangleMesh& mesh) {
  const auto flattest = std::min_element(mesh.triangles.begin(), mesh.triangles.end(),
                                         [&](const auto& a, const auto& b) { return height_of(mesh, a) < height_of(mesh, b); });
  for (std::size_t k = 0; k < 3; ++k) draw_edge(canvas, view, mesh, (*flattest)[k], (*flattest)[(k + 1) % 3], flat_colour, 2.5);
}

void draw_caption(Canvas& canvas, const fdem::MadeMesh& made, const fdem::MeshChoice& choice) {
  const auto cracks = std::count(made.mesh.edge_kind.begin(), made.mesh.edge_kind.end(), EdgeKind::crack);
  const fdem::MeshReport& r = made.report;
  const int y = canvas.height() - caption + 20;
  canvas.text(margin, y,
              fmt::format("{} triangles, {} nodes, {} inner edges, {} of them cracks (red); body {:.4g} x {:.4g} m, elements of {:.4g} mm",
                          made.mesh.triangles.size(), made.mesh.nodes.size(), made.mesh.edge_nodes.size(), cracks, choice.width,
                          choice.height, 1e3 * choice.element_size),
              black, Align::left, Font::bold);
  canvas.text(
      margin, y + 22,
      fmt::format(
          "smallest height {:.3f} mm (its triangle in orange), smallest angle {:.1f} degrees; {} moved, {} trimmed, {} extended, {} merged",
          1e3 * r.smallest_height, r.smallest_angle, r.moved, r.trimmed, r.extended, r.merged));
}

}  // namespace

Canvas draw_mesh(const fdem::MadeMesh& made, const fdem::MeshChoice& choice) {
  const View view{longer_side / std::max(choice.width, choice.height), choice.height};
  const int width = std::max(static_cast<int>(view.scale * choice.width), 800), height = static_cast<int>(view.scale * choice.height);
  Canvas canvas(width + 2 * margin, height + 2 * margin + caption);
  const TriangleMesh& mesh = made.mesh;
  for (const auto& [a, b, c] : mesh.triangles) {  // the sides' edges, too, which are in no list
    draw_edge(canvas, view, mesh, a, b, edge_colour, 0.8);
    draw_edge(canvas, view, mesh, b, c, edge_colour, 0.8);
    draw_edge(canvas, view, mesh, c, a, edge_colour, 0.8);
  }
  for (const double z : choice.layers) canvas.line(view.x(0), view.y(z), view.x(choice.width), view.y(z), layer_colour, 2.0);
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e)
    if (mesh.edge_kind[e] == EdgeKind::crack)
      draw_edge(canvas, view, mesh, mesh.edge_nodes[e][0], mesh.edge_nodes[e][1], crack_colour, 3.0);
  draw_flattest(canvas, view, mesh);
  draw_caption(canvas, made, choice);
  return canvas;
}

}  // namespace fracfarm
