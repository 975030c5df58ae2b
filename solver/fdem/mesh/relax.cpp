#include "solver/fdem/mesh/relax.hpp"

#include <algorithm>
#include <limits>

namespace fracfarm::fdem {
namespace {

constexpr int fill_passes = 8;
constexpr double flat_share = 0.5;  // of the element size: triangles of less height are mended where a free point can do it
constexpr int flat_rounds = 4;

Vec as_vec(Point p) { return {static_cast<double>(p.x), static_cast<double>(p.z)}; }
Point as_point(Vec p) { return {static_cast<std::int32_t>(std::lround(p.x)), static_cast<std::int32_t>(std::lround(p.z))}; }

// Of a triangle at the origin with corners u and v.
Vec circumcentre(Vec u, Vec v) {
  const double twice = 2 * cross(u, v), uu = dot(u, u), vv = dot(v, v);
  return {(v.z * uu - u.z * vv) / twice, (u.x * vv - v.x * uu) / twice};
}

double height_squared(Vec a, Vec b, Vec c) {
  const double area = cross(b - a, c - a);
  const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return area > 0 ? area * area / longest : -1.0;
}

using Star = std::vector<std::pair<int, int>>;

struct Ring {
  Vec a, b;  // the edge opposite the point, counter-clockwise
};

void ring_of(const Triangulation& triangles, const Star& star, std::vector<Ring>& ring) {
  ring.clear();
  for (const auto& [t, k] : star) {
    const Triangle& it = triangles.triangles()[static_cast<std::size_t>(t)];
    ring.push_back({as_vec(triangles.points()[static_cast<std::size_t>(it.corner[(k + 1) % 3])]),
                    as_vec(triangles.points()[static_cast<std::size_t>(it.corner[(k + 2) % 3])])});
  }
}

bool valid_at(Vec p, const std::vector<Ring>& ring) {
  return std::all_of(ring.begin(), ring.end(), [&](const Ring& edge) { return cross(edge.a - p, edge.b - p) > 0; });
}

// Centre of the circumcentres, weighted by area: the best place for a point in an optimal Delaunay triangulation (L. Chen, 2004).
Vec balanced(Vec p, const std::vector<Ring>& ring) {
  Vec sum;
  double area = 0.0;
  for (const Ring& edge : ring) {
    const Vec u = edge.a - p, v = edge.b - p;
    const double twice = cross(u, v);
    sum = sum + twice * circumcentre(u, v);
    area += twice;
  }
  return p + (1.0 / area) * sum;
}

double flattest(Vec p, const std::vector<Ring>& ring) {
  double least = std::numeric_limits<double>::infinity();
  for (const Ring& edge : ring) least = std::min(least, height_squared(p, edge.a, edge.b));
  return least;
}

constexpr std::array<Vec, 8> directions{{{1, 0}, {0.7, 0.7}, {0, 1}, {-0.7, 0.7}, {-1, 0}, {-0.7, -0.7}, {0, -1}, {0.7, -0.7}}};

// Where within half an element of p the flattest triangle of the star is highest: a search with halved steps.
Vec highest(Vec p, const std::vector<Ring>& ring, double element_size) {
  double best = flattest(p, ring);
  for (double step = 0.25 * element_size; step > 0.02 * element_size; step *= 0.5)
    for (int turn = 0; turn < 3; ++turn) {
      const Vec from = p;
      for (const Vec direction : directions) {
        const Vec to = as_vec(as_point(from + step * direction));
        const double height = flattest(to, ring);
        if (height > best) best = height, p = to;
      }
      if (p.x == from.x && p.z == from.z) break;
    }
  return p;
}

}  // namespace

void fill_gaps(Triangulation& triangles, const Lattice& lattice, const CrackGraph& lines, const Spacing& spacing) {
  const double least = spacing.between / lattice.unit() * (spacing.between / lattice.unit());
  const Point end = triangles.points()[2];
  bool filled = true;
  for (int pass = 0; pass < fill_passes && filled; ++pass) {
    filled = false;
    for (int t = 0; t < static_cast<int>(triangles.triangles().size()); ++t) {
      const auto [a, b, c] = triangles.triangles()[static_cast<std::size_t>(t)].corner;
      const auto& points = triangles.points();
      const Vec origin = as_vec(points[static_cast<std::size_t>(a)]);
      const Vec to =
          circumcentre(as_vec(points[static_cast<std::size_t>(b)]) - origin, as_vec(points[static_cast<std::size_t>(c)]) - origin);
      if (dot(to, to) <= least) continue;
      const Vec centre = origin + to;
      if (!(centre.x > 0 && centre.z > 0 && centre.x < end.x && centre.z < end.z)) continue;
      const Vec metres = lattice.unit() * centre;
      if (!lines.clear(metres, spacing.from_vertices, spacing.from_edges)) continue;
      const Point p = as_point(centre);
      const int holder = triangles.locate_in_sight(p, t);
      if (holder < 0) continue;
      triangles.insert(p, holder);
      filled = true;
    }
  }
}

bool smooth(const Relaxation& relaxation, int sweeps) {
  Triangulation& triangles = relaxation.triangles;
  Star star;
  std::vector<Ring> ring;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int point = relaxation.first_free; point < static_cast<int>(triangles.points().size()); ++point) {
      if (!triangles.star(point, star)) continue;
      ring_of(triangles, star, ring);
      const Vec from = as_vec(triangles.points()[static_cast<std::size_t>(point)]);
      Vec to = balanced(from, ring);
      for (int halving = 0; halving < 3; ++halving, to = 0.5 * (from + to)) {
        const Vec there = as_vec(as_point(to));
        if (!valid_at(there, ring)) continue;
        triangles.move(point, as_point(there));
        break;
      }
    }
    if (!triangles.restore()) return false;
  }
  return true;
}

bool mend_flat(const Relaxation& relaxation) {
  Triangulation& triangles = relaxation.triangles;
  const double least = flat_share * relaxation.element_size * flat_share * relaxation.element_size;
  Star star;
  std::vector<Ring> ring;
  for (int round = 0; round < flat_rounds; ++round) {
    bool moved = false;
    for (std::size_t t = 0; t < triangles.triangles().size(); ++t) {
      const auto corners = triangles.triangles()[t].corner;
      const auto at = [&](int k) { return as_vec(triangles.points()[static_cast<std::size_t>(corners[k])]); };
      if (height_squared(at(0), at(1), at(2)) >= least) continue;
      for (const int point : corners) {
        if (point < relaxation.first_free || !triangles.star(point, star)) continue;
        ring_of(triangles, star, ring);
        const Vec from = as_vec(triangles.points()[static_cast<std::size_t>(point)]);
        const Point to = as_point(highest(from, ring, relaxation.element_size));
        if (to == as_point(from)) continue;
        triangles.move(point, to);
        moved = true;
      }
    }
    if (!moved) return true;
    if (!triangles.restore()) return false;
  }
  return true;
}

}  // namespace fracfarm::fdem
