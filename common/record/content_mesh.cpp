// Whether a mesh is a mesh of the scene: triangles that tile its rectangle, an edge wherever two of them meet, cracks where they were
// drawn.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/record/content_rules.hpp"
#include "common/scene/pattern.hpp"

namespace fracfarm::content {
namespace {

using Point = std::array<double, 2>;

double twice_area(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Point &a = mesh.nodes[static_cast<std::size_t>(t[0])], &b = mesh.nodes[static_cast<std::size_t>(t[1])],
              &c = mesh.nodes[static_cast<std::size_t>(t[2])];
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Which side of triangle leads from one node to the other, counter-clockwise; 3 where none does.
std::size_t side_of(const std::array<int, 3>& triangle, int from, int to) {
  std::size_t k = 0;
  while (k < 3 && !(triangle[k] == from && triangle[(k + 1) % 3] == to)) ++k;
  return k;
}

// Both ends on one side of the rectangle.
bool on_boundary(const Point& a, const Point& b, const Scene& scene) {
  const double tolerance = 1e-9 * std::max(scene.width, scene.height);
  const auto both = [&](std::size_t axis, double place) {
    return std::abs(a[axis] - place) <= tolerance && std::abs(b[axis] - place) <= tolerance;
  };
  return both(0, 0.0) || both(0, scene.width) || both(1, 0.0) || both(1, scene.height);
}

// Squares: only the largest of many distances needs its root.
double distance_squared(const Point& p, const Point& a, const Point& b) {
  const double dx = b[0] - a[0], dz = b[1] - a[1], square = dx * dx + dz * dz;
  const double along = square > 0.0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dz) / square, 0.0, 1.0) : 0.0;
  const double away_x = p[0] - a[0] - along * dx, away_z = p[1] - a[1] - along * dz;
  return away_x * away_x + away_z * away_z;
}

struct Line {
  Point a, b;
};

double distance_squared(const Point& p, const std::vector<Line>& lines) {
  double least = infinity;
  for (const Line& line : lines) least = std::min(least, distance_squared(p, line.a, line.b));
  return least;
}

std::vector<Line> crack_edges(const TriangleMesh& mesh) {
  std::vector<Line> lines;
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e)
    if (mesh.edge_kind[e] == EdgeKind::crack)
      lines.push_back(
          {mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[e][0])], mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[e][1])]});
  return lines;
}

// Points of the drawn cracks, an element apart, that the mesh must have: of cracks longer than two elements, which no repair removes, and
// not within an element of the boundary, where no edge has two triangles.
std::vector<Point> drawn_points(const Scene& scene, double h, std::size_t most) {
  std::vector<Point> points;
  for (Segment s : scene.cracks) {
    if (!clip(s, scene.width, scene.height)) continue;
    const double length = std::hypot(s.x1 - s.x0, s.z1 - s.z0);
    if (!(length > 2.0 * h)) continue;
    for (double at = 0.0; at <= length && points.size() <= most; at += h) {
      const Point p{s.x0 + (s.x1 - s.x0) * at / length, s.z0 + (s.z1 - s.z0) * at / length};
      if (p[0] > h && p[0] < scene.width - h && p[1] > h && p[1] < scene.height - h) points.push_back(p);
    }
  }
  return points;
}

}  // namespace

double outside_domain(const Context& c) {
  if (!c.scene) return infinity;
  double worst = 0.0;
  for (const auto& [x, z] : c.record.fdem.mesh.nodes) {
    const double outside = std::max(std::max(-x, x - c.scene->width), std::max(-z, z - c.scene->height));
    if (!(outside <= worst)) worst = std::isnan(outside) ? infinity : outside;
  }
  return worst / c.scene->fdem.element_size;
}

double turned_triangles(const Context& c) {
  const TriangleMesh& mesh = c.record.fdem.mesh;
  return static_cast<double>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                           [&](const std::array<int, 3>& t) { return !(twice_area(mesh, t) > 0.0); }));
}

double area_difference(const Context& c) {
  if (!c.scene) return infinity;
  double area = 0.0;
  for (const std::array<int, 3>& triangle : c.record.fdem.mesh.triangles) area += 0.5 * twice_area(c.record.fdem.mesh, triangle);
  return std::abs(area / (c.scene->width * c.scene->height) - 1.0);
}

double unmatched_edges(const Context& c) {
  if (!c.scene) return infinity;
  const TriangleMesh& mesh = c.record.fdem.mesh;
  std::vector<unsigned char> matched(3 * mesh.triangles.size(), 0);
  std::size_t count = 0;
  const auto match = [&](int triangle, int from, int to) {
    const std::size_t t = static_cast<std::size_t>(triangle), side = side_of(mesh.triangles[t], from, to);
    if (side < 3 && !matched[3 * t + side])
      matched[3 * t + side] = 1;
    else
      ++count;
  };
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e) {
    match(mesh.edge_triangles[e][0], mesh.edge_nodes[e][0], mesh.edge_nodes[e][1]);
    match(mesh.edge_triangles[e][1], mesh.edge_nodes[e][1], mesh.edge_nodes[e][0]);
  }
  for (std::size_t side = 0; side < matched.size(); ++side) {
    if (matched[side]) continue;
    const std::array<int, 3>& triangle = mesh.triangles[side / 3];
    const auto node = [&](std::size_t k) -> const Point& { return mesh.nodes[static_cast<std::size_t>(triangle[k % 3])]; };
    count += !on_boundary(node(side % 3), node(side % 3 + 1), *c.scene);
  }
  return static_cast<double>(count);
}

double crack_distance(const Context& c) {
  constexpr double work_limit = 3e8;  // pairs of points and lines: a second
  if (!c.scene) return infinity;
  const double h = c.scene->fdem.element_size;
  const std::vector<Line> edges = crack_edges(c.record.fdem.mesh);
  std::vector<Line> drawn;
  for (const Segment& s : c.scene->cracks) drawn.push_back({{s.x0, s.z0}, {s.x1, s.z1}});
  const double pairs = 3.0 * static_cast<double>(edges.size()) * static_cast<double>(drawn.size());
  const std::size_t most = static_cast<std::size_t>(work_limit) / std::max<std::size_t>(edges.size(), 1);
  const std::vector<Point> points = drawn_points(*c.scene, h, most);
  if (pairs > work_limit || points.size() > most) return infinity;
  double worst = 0.0;
  for (const Line& edge : edges)
    for (const Point& p : {edge.a, Point{0.5 * (edge.a[0] + edge.b[0]), 0.5 * (edge.a[1] + edge.b[1])}, edge.b})
      worst = std::max(worst, distance_squared(p, drawn));
  for (const Point& p : points) worst = std::max(worst, distance_squared(p, edges));
  return std::sqrt(worst) / h;
}

}  // namespace fracfarm::content
