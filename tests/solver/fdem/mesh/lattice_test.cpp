#include "solver/fdem/mesh/lattice.hpp"

#include <catch2/catch.hpp>

#include <set>

namespace fracfarm::fdem {

TEST_CASE("circle tests are exact where four points lie on one circle, and next to it") {
  constexpr std::int32_t r = 5 << 24, x = 3 << 24, z = 4 << 24, m = 1 << 27;  // (3, 4, 5): 24-bit multiples of it on a circle about (m, m)
  const Point a{m + r, m}, b{m, m + r}, c{m - x, m - z}, d{m + x, m - z};
  CHECK_FALSE(in_circle(a, b, c, d));
  CHECK(in_circle(a, b, c, {d.x - 1, d.z}));
  CHECK_FALSE(in_circle(a, b, c, {d.x + 1, d.z}));
  CHECK(in_circle(a, b, c, {d.x, d.z + 1}));
  CHECK_FALSE(in_circle(a, b, c, {d.x, d.z - 1}));
}

TEST_CASE("orientation tells one unit beside a line across the whole lattice") {
  constexpr std::int32_t most = 1 << 28;
  CHECK(orientation({0, 0}, {most, most}, {most / 2, most / 2}) == 0);
  CHECK(orientation({0, 0}, {most, most - 1}, {1, 1}) > 0);
  CHECK(orientation({0, 0}, {most - 1, most}, {1, 1}) < 0);
}

TEST_CASE("sides and layers come back from the lattice to the bit") {
  const Lattice lattice(0.25, 0.1, {0.07, 0.033});
  CHECK(lattice.upper_right().x == 1 << 27);  // the lattice spans 0.5 m
  CHECK(lattice.x(lattice.upper_right()) == 0.25);
  CHECK(lattice.z(lattice.upper_right()) == 0.1);
  CHECK(lattice.z(lattice.nearest(0.1, 0.07)) == 0.07);
  CHECK(lattice.z(lattice.nearest(0.2, 0.033)) == 0.033);
  CHECK(lattice.x({12345, 0}) == 12345 * lattice.unit());
}

TEST_CASE("the Hilbert curve visits every cell once, each beside the last") {
  std::set<std::uint32_t> seen;
  std::vector<std::array<std::uint32_t, 2>> at(256);
  for (std::uint32_t x = 0; x < 16; ++x)
    for (std::uint32_t z = 0; z < 16; ++z) {
      const std::uint32_t index = hilbert_index(x << 12, z << 12) >> 24;
      REQUIRE(index < 256);
      CHECK(seen.insert(index).second);
      at[index] = {x, z};
    }
  for (std::size_t i = 1; i < at.size(); ++i) {
    const auto step = [&](std::size_t axis) { return std::abs(static_cast<int>(at[i][axis]) - static_cast<int>(at[i - 1][axis])); };
    CHECK(step(0) + step(1) == 1);
  }
}

}  // namespace fracfarm::fdem
