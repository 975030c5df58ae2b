#include "solver/fdem/mesh/relax.hpp"

#include <catch2/catch.hpp>

#include "common/base/random.hpp"

namespace fracfarm::fdem {
namespace {

constexpr std::int32_t size = 1 << 20;

struct Shape {
  double lowest = 1e300;    // height
  double unevenness = 0.0;  // of edge lengths: standard deviation over mean
};

Shape shape_of(const Triangulation& triangles) {
  Shape shape;
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const Triangle& it : triangles.triangles()) {
    const auto p = [&](int k) { return triangles.points()[static_cast<std::size_t>(it.corner[static_cast<std::size_t>(k)])]; };
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double square = distance_squared(p(k), p((k + 1) % 3));
      longest = std::max(longest, square);
      sum += std::sqrt(square), squares += square, ++count;
    }
    shape.lowest = std::min(shape.lowest, static_cast<double>(orientation(p(0), p(1), p(2))) / std::sqrt(longest));
  }
  shape.unevenness = std::sqrt(squares / count - sum * sum / count / count) / (sum / count);
  return shape;
}

}  // namespace

TEST_CASE("a flat triangle is mended by moving its free point, fixed points stay") {
  Triangulation triangles({size, size});
  triangles.insert({size / 2, size / 100}, 0);
  REQUIRE(shape_of(triangles).lowest < 0.02 * size);
  REQUIRE(mend_flat({triangles, 4, 0.7 * size}));
  CHECK(shape_of(triangles).lowest > 0.35 * size);
  Triangulation fixed({size, size});
  fixed.insert({size / 2, size / 100}, 0);
  REQUIRE(mend_flat({fixed, 5, 0.7 * size}));
  CHECK(fixed.points()[4] == Point{size / 2, size / 100});
}

TEST_CASE("smoothing evens out random points and keeps the triangulation sound") {
  Triangulation triangles({size, size});
  RandomStream random(3, 1, 1);
  int near = 0;
  for (int side = 1; side < 16; ++side)  // points along the sides, which stay
    for (const Point p :
         {Point{side * size / 16, 0}, Point{side * size / 16, size}, Point{0, side * size / 16}, Point{size, side * size / 16}})
      near = triangles.triangle_of(triangles.insert(p, near));
  const int first_free = static_cast<int>(triangles.points().size());
  for (int i = 0; i < 300; ++i)
    near = triangles.triangle_of(triangles.insert({random.integer(1, size - 1), random.integer(1, size - 1)}, near));
  const double before = shape_of(triangles).unevenness;
  REQUIRE(smooth({triangles, first_free, size / 16.0}, 5));
  const Shape after = shape_of(triangles);
  CHECK(after.lowest > 0);
  CHECK(after.unevenness < 0.6 * before);
}

}  // namespace fracfarm::fdem
