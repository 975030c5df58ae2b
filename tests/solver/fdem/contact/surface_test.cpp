// How exposed sides follow one another around bodies, corners and crack tips.
#include "solver/fdem/contact/surface.hpp"

#include <catch2/catch.hpp>

#include "tests/solver/fdem/contact/bodies.hpp"

using namespace fracfarm::fdem;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double h = 3e-3;

// The side of the triangle that runs from one point to the other, in cells.
int side_from(const Triangles<double>& triangles, std::array<double, 2> a, std::array<double, 2> b) {
  for (int t = 0; t < triangles.count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      const double from = std::hypot(triangles.x(t, k) - a[0] * h, triangles.z(t, k) - a[1] * h);
      if (from + std::hypot(triangles.x(t, l) - b[0] * h, triangles.z(t, l) - b[1] * h) < 1e-9) return 3 * t + k;
    }
  FAIL("no such side");
  return -1;
}

void expose_edge(const Triangles<double>& triangles, Surface& surface, std::array<double, 2> a, std::array<double, 2> b) {
  surface.expose({side_from(triangles, a, b), 1});
  surface.expose({side_from(triangles, b, a), 1});
}

const ExposedSide& at(const Triangles<double>& triangles, const Surface& surface, std::array<double, 2> a, std::array<double, 2> b) {
  return surface.sides()[static_cast<std::size_t>(surface.place(side_from(triangles, a, b)))];
}

TriangleSide next_of(const Surface& surface, const ExposedSide& side) { return surface.sides()[static_cast<std::size_t>(side.next)].id; }

}  // namespace

TEST_CASE("The sides of a block's boundary go round it once") {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {4 * h, 3 * h}, {4, 3});
  Surface surface(triangles.corners, triangles.neighbour);
  for (std::size_t s = 0; s < triangles.neighbour.size(); ++s)
    if (triangles.neighbour[s] < 0) surface.expose({static_cast<int>(s), 0});
  CHECK(surface.sides().empty());
  surface.commit();
  int place = 0, seen = 0;
  do {
    const ExposedSide& side = surface.sides()[static_cast<std::size_t>(place)];
    CHECK(side.joined_end);
    CHECK(surface.sides()[static_cast<std::size_t>(side.next)].previous == place);
    CHECK(surface.same_corner(place, side.next));
    place = side.next;
    ++seen;
  } while (place != 0 && seen < 100);
  CHECK(seen == 14);
}

TEST_CASE("A crack's faces follow each other at its tips, where they may press on each other, and side by side along it") {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {6 * h, 4 * h}, {6, 4});
  Surface surface(triangles.corners, triangles.neighbour);
  expose_edge(triangles, surface, {2, 2}, {3, 2});
  surface.commit();
  const ExposedSide &over = at(triangles, surface, {2, 2}, {3, 2}), &under = at(triangles, surface, {3, 2}, {2, 2});
  CHECK(next_of(surface, over) == under.id);
  CHECK(next_of(surface, under) == over.id);
  CHECK_FALSE(over.joined_end);
  CHECK_FALSE(surface.same_corner(0, 1));
  expose_edge(triangles, surface, {3, 2}, {4, 2});
  surface.commit();
  const ExposedSide& first = at(triangles, surface, {2, 2}, {3, 2});
  CHECK(next_of(surface, first) == side_from(triangles, {3, 2}, {4, 2}));
  CHECK(first.joined_end);
  CHECK(next_of(surface, at(triangles, surface, {3, 2}, {4, 2})) == side_from(triangles, {4, 2}, {3, 2}));
  CHECK(next_of(surface, at(triangles, surface, {4, 2}, {3, 2})) == side_from(triangles, {3, 2}, {2, 2}));
}

TEST_CASE("A branch parts the bodies at its foot") {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {6 * h, 4 * h}, {6, 4});
  Surface surface(triangles.corners, triangles.neighbour);
  expose_edge(triangles, surface, {2, 2}, {3, 2});
  expose_edge(triangles, surface, {3, 2}, {4, 2});
  surface.commit();
  expose_edge(triangles, surface, {3, 2}, {3, 3});
  surface.commit();
  CHECK(next_of(surface, at(triangles, surface, {2, 2}, {3, 2})) == side_from(triangles, {3, 2}, {3, 3}));
  CHECK(next_of(surface, at(triangles, surface, {3, 3}, {3, 2})) == side_from(triangles, {3, 2}, {4, 2}));
  CHECK(at(triangles, surface, {2, 2}, {3, 2}).joined_end);  // a right angle
  CHECK(next_of(surface, at(triangles, surface, {4, 2}, {3, 2})) == side_from(triangles, {3, 2}, {2, 2}));
}
