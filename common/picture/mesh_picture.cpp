#include "common/picture/mesh_picture.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

namespace fracfarm::picture {
namespace {

constexpr Colour mesh_colour{214, 217, 222};
constexpr int least_pixels_an_edge = 4;  // below it the lines of a mesh run together

unsigned char mixed(unsigned char a, unsigned char b, double share) { return static_cast<unsigned char>(std::lround(a + (b - a) * share)); }

Colour mixed(Colour a, Colour b, double share) { return {mixed(a.r, b.r, share), mixed(a.g, b.g, share), mixed(a.b, b.b, share)}; }

class Paper {
 public:
  Paper(const TriangleMesh& mesh, int width) : mesh_(mesh) {
    for (const auto& [x, z] : mesh.nodes) across_ = std::max(across_, x), up_ = std::max(up_, z);
    const double pixels = up_ > 0.0 && across_ > 0.0 ? width * up_ / across_ : width;
    height_ = static_cast<int>(std::clamp(std::round(pixels), 24.0, 3.0 * width));
    scale_x_ = across_ > 0.0 ? (width - 1) / across_ : 0.0, scale_z_ = up_ > 0.0 ? (height_ - 1) / up_ : 0.0;
  }

  int height() const { return height_; }
  // Of a mesh of so many triangles.
  double pixels_an_edge() const {
    const double area = across_ * up_ * scale_x_ * scale_z_ / std::max<double>(1.0, static_cast<double>(mesh_.triangles.size()));
    return std::sqrt(area / 0.433);
  }
  void line(Canvas& canvas, int from, int to, Colour colour, double thickness) const {
    const auto &a = mesh_.nodes[static_cast<std::size_t>(from)], &b = mesh_.nodes[static_cast<std::size_t>(to)];
    canvas.line(a[0] * scale_x_, height_ - 1 - a[1] * scale_z_, b[0] * scale_x_, height_ - 1 - b[1] * scale_z_, colour, thickness);
  }

 private:
  const TriangleMesh& mesh_;
  double across_ = 0.0, up_ = 0.0, scale_x_ = 0.0, scale_z_ = 0.0;
  int height_ = 0;
};

void draw_triangles(Canvas& canvas, const TriangleMesh& mesh, const Paper& paper) {
  for (const std::array<int, 3>& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3]) paper.line(canvas, t[k], t[(k + 1) % 3], mesh_colour, 0.6);
}

}  // namespace

Colour softening(double damage) {
  constexpr Colour begun{247, 224, 150}, nearly_broken{240, 122, 18};
  return mixed(begun, nearly_broken, std::clamp(damage, 0.0, 1.0));
}

Canvas draw_mesh(const TriangleMesh& mesh, std::span<const float> damage, int width) {
  assert(damage.empty() || damage.size() == mesh.edge_nodes.size());
  const Paper paper(mesh, width);
  Canvas canvas(width, paper.height());
  if (paper.pixels_an_edge() >= least_pixels_an_edge) draw_triangles(canvas, mesh, paper);
  const double bold = std::clamp(0.4 * paper.pixels_an_edge(), 1.4, 3.0);
  const auto value = [&](std::size_t e) { return !damage.empty() ? damage[e] : mesh.edge_kind[e] == EdgeKind::crack ? 2.0f : 0.0f; };
  std::vector<std::size_t> order(mesh.edge_nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value(a) < value(b); });  // the worst on top
  for (std::size_t e : order) {
    const float d = value(e);
    if (!(d > 0.0f)) continue;
    const Colour colour = d == 2.0f ? initial_crack_colour : d == 1.0f ? broken_colour : softening(d);
    paper.line(canvas, mesh.edge_nodes[e][0], mesh.edge_nodes[e][1], colour, d >= 1.0f ? bold : 0.7 * bold);
  }
  return canvas;
}

void draw_mesh_key(Canvas& canvas, const Box& box) {
  int y = box.y + 12;
  const auto entry = [&](Colour colour, std::string_view words) {
    canvas.line(box.x, y, box.x + 22, y, colour, 3.0);
    canvas.text(box.x + 30, y + 4, words);
    y += 22;
  };
  entry(initial_crack_colour, "initial crack");
  entry(broken_colour, "broken");
  canvas.text(box.x, y + 12, "softening");
  for (int row = 0; row < 90; ++row) canvas.fill({box.x, y + 22 + row, 14, 1}, softening(1.0 - row / 89.0));
  canvas.frame({box.x, y + 22, 14, 90}, grey);
  canvas.text(box.x + 20, y + 32, "1", grey);
  canvas.text(box.x + 20, y + 112, "0", grey);
}

}  // namespace fracfarm::picture
