#include "solver/fdem/mesh/triangulation.hpp"

#include <boost/polygon/voronoi.hpp>
#include <catch2/catch.hpp>

#include <set>

#include "common/base/random.hpp"

namespace fracfarm::fdem {
namespace {

using Edges = std::set<std::pair<int, int>>;

Edges edges_of(const Triangulation& triangulation) {
  Edges edges;
  for (const Triangle& triangle : triangulation.triangles())
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangle.corner[k], triangle.corner[(k + 1) % 3]);
      edges.insert({a, b});
    }
  return edges;
}

// Counter-clockwise, neighbours that know each other, areas that fill the rectangle.
void check_sound(const Triangulation& triangulation) {
  std::int64_t area = 0;
  const auto& points = triangulation.points();
  for (int t = 0; t < static_cast<int>(triangulation.triangles().size()); ++t) {
    const Triangle& it = triangulation.triangles()[static_cast<std::size_t>(t)];
    const std::int64_t twice = orientation(points[it.corner[0]], points[it.corner[1]], points[it.corner[2]]);
    REQUIRE(twice > 0);
    area += twice;
    for (std::size_t k = 0; k < 3; ++k) {
      if (it.across[k] < 0) continue;
      const Triangle& other = triangulation.triangles()[static_cast<std::size_t>(it.across[k])];
      REQUIRE(std::count(other.across.begin(), other.across.end(), t) == 1);
      REQUIRE(std::count(other.corner.begin(), other.corner.end(), it.corner[k]) == 0);
    }
  }
  CHECK(area == 2 * static_cast<std::int64_t>(points[2].x) * points[2].z);
}

Triangulation random_triangulation(int count, std::int32_t size, int seed) {
  RandomStream random(static_cast<std::uint64_t>(seed), 1, 1);
  Triangulation triangulation({size, size});
  int near = 0;
  for (int i = 0; i < count; ++i)
    near = triangulation.triangle_of(triangulation.insert({random.integer(0, size), random.integer(0, size)}, near));
  return triangulation;
}

}  // namespace

TEST_CASE("the triangulation of random points is the dual of their Voronoi diagram") {
  const Triangulation triangulation = random_triangulation(2000, 1 << 28, 3);
  check_sound(triangulation);
  std::vector<boost::polygon::point_data<std::int32_t>> points;
  for (const Point p : triangulation.points()) points.emplace_back(p.x, p.z);
  boost::polygon::voronoi_diagram<double> diagram;
  boost::polygon::construct_voronoi(points.begin(), points.end(), &diagram);
  Edges dual;
  for (const auto& edge : diagram.edges()) {
    const int a = static_cast<int>(edge.cell()->source_index()), b = static_cast<int>(edge.twin()->cell()->source_index());
    dual.insert({std::min(a, b), std::max(a, b)});
  }
  CHECK((edges_of(triangulation) == dual));
}

TEST_CASE("points on lines, on sides, on a coarse lattice and given twice make a sound triangulation") {
  for (const std::int32_t size : {1, 2, 7, 20, 300}) {
    const Triangulation triangulation = random_triangulation(600, size, size);
    check_sound(triangulation);
    CHECK(triangulation.points().size() <= static_cast<std::size_t>(size + 1) * static_cast<std::size_t>(size + 1));
    CHECK(triangulation.triangles().size() >= 2);
  }
}

TEST_CASE("no circle about a triangle holds a point unless a demanded edge stands between them") {
  Triangulation triangulation = random_triangulation(400, 1 << 20, 5);
  const Edges before = edges_of(triangulation);
  int demanded = 0;
  Edges kept;
  for (int a = 4; a < 60; a += 2) {
    if (!triangulation.constrain(a, a + 1)) continue;  // crosses one that was demanded
    ++demanded;
    kept.insert({a, a + 1});
  }
  REQUIRE(triangulation.restore());
  check_sound(triangulation);
  const Edges after = edges_of(triangulation);
  CHECK(demanded >= 8);
  for (const auto& edge : kept) CHECK(after.contains(edge));
  CHECK(std::count_if(kept.begin(), kept.end(), [&](const auto& edge) { return !before.contains(edge); }) >= 5);
  for (const Triangle& it : triangulation.triangles())
    for (std::size_t k = 0; k < 3; ++k) {
      if (it.across[k] < 0 || it.constrained[k]) continue;
      const Triangle& other = triangulation.triangles()[static_cast<std::size_t>(it.across[k])];
      for (const int far : other.corner) {
        const auto& p = triangulation.points();
        CHECK_FALSE(in_circle(p[it.corner[0]], p[it.corner[1]], p[it.corner[2]], p[far]));
      }
    }
}

TEST_CASE("an edge through a point or across a demanded edge cannot be demanded") {
  Triangulation triangulation({100, 100});
  const int left = triangulation.insert({20, 50}, 0), middle = triangulation.insert({50, 50}, 0), right = triangulation.insert({80, 50}, 0);
  const int low = triangulation.insert({40, 20}, 0), high = triangulation.insert({40, 80}, 0);
  CHECK_FALSE(triangulation.constrain(left, right));
  CHECK(triangulation.constrain(left, middle));
  CHECK_FALSE(triangulation.constrain(low, high));
  CHECK(triangulation.constrain(middle, right));
  check_sound(triangulation);
}

TEST_CASE("points that moved are flipped back to Delaunay") {
  Triangulation triangulation = random_triangulation(300, 1 << 16, 9);
  std::vector<std::pair<int, int>> star;
  RandomStream random(4, 1, 1);
  int moved = 0;
  for (int point = 4; point < 300; ++point) {
    if (!triangulation.star(point, star)) continue;
    const Point to{triangulation.points()[static_cast<std::size_t>(point)].x + random.integer(-600, 600),
                   triangulation.points()[static_cast<std::size_t>(point)].z + random.integer(-600, 600)};
    const bool valid = std::all_of(star.begin(), star.end(), [&](const auto& place) {
      const auto& corner = triangulation.triangles()[static_cast<std::size_t>(place.first)].corner;
      const auto& p = triangulation.points();
      return orientation(to, p[corner[(place.second + 1) % 3]], p[corner[(place.second + 2) % 3]]) > 0;
    });
    if (valid) triangulation.move(point, to), ++moved;
  }
  CHECK(moved > 50);
  REQUIRE(triangulation.restore());
  check_sound(triangulation);
  Triangulation fresh({1 << 16, 1 << 16});
  for (std::size_t i = 4; i < triangulation.points().size(); ++i) fresh.insert(triangulation.points()[i], 0);
  CHECK((edges_of(fresh) == edges_of(triangulation)));
}

}  // namespace fracfarm::fdem
