#include "solver/phasefield/slots.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

using namespace fracfarm;
using namespace fracfarm::phasefield;

namespace {

using Elements = std::vector<std::pair<int, int>>;
const Grid grid{11, 11, 0.1, 0.1};  // 10 x 10 elements on a unit square

}  // namespace

TEST_CASE("a segment crosses the elements that it runs through, ends included, and no others") {
  CHECK(crossed_elements({0.15, 0.55, 0.38, 0.55}, grid) == Elements{{1, 5}, {2, 5}, {3, 5}});
  CHECK(crossed_elements({0.55, 0.31, 0.55, 0.12}, grid) == Elements{{5, 3}, {5, 2}, {5, 1}});
  CHECK(crossed_elements({0.05, 0.02, 0.15, 0.12}, grid) == Elements{{0, 0}, {1, 0}, {1, 1}});
}

TEST_CASE("a segment through the corner of elements does not cross those it only touches") {
  CHECK(crossed_elements({0.05, 0.05, 0.25, 0.25}, grid) == Elements{{0, 0}, {1, 1}, {2, 2}});
  CHECK(crossed_elements({0.1, 0.55, 0.3, 0.55}, grid) == Elements{{1, 5}, {2, 5}});
}

TEST_CASE("a segment on a grid line belongs to the elements above it or right of it, on the last line to those inside") {
  CHECK(crossed_elements({0.1, 0.3, 0.3, 0.3}, grid) == Elements{{1, 3}, {2, 3}});
  CHECK(crossed_elements({0.7, 0.5, 0.7, 0.6}, grid) == Elements{{7, 5}});
  CHECK(crossed_elements({0.2, 1.0, 0.3, 1.0}, grid) == Elements{{2, 9}});
}

TEST_CASE("parts outside the grid are dropped, however far they reach, and the slope is kept") {
  CHECK(crossed_elements({-1e6, 0.25, 0.15, 0.25}, grid) == Elements{{0, 2}, {1, 2}});
  CHECK(crossed_elements({0.85, 0.85, 100.85, 100.85}, grid) == Elements{{8, 8}, {9, 9}});
  CHECK(crossed_elements({2.0, 2.0, 3.0, 2.5}, grid).empty());
}

TEST_CASE("a slot holds the four nodes of each element that it crosses") {
  const std::vector<Segment> cracks{{0.15, 0.55, 0.38, 0.55}};
  const std::vector<unsigned char> mask = slot_mask(cracks, grid);
  CHECK(std::accumulate(mask.begin(), mask.end(), 0) == 8);
  for (const int row : {5, 6})
    for (int column = 1; column <= 4; ++column) CHECK(mask[static_cast<std::size_t>(row * 11 + column)] == 1);
}

TEST_CASE("a row of nodes follows its segment, one node on each grid line that it crosses at the steeper angle") {
  const auto held = [&](const Segment& crack) {
    std::vector<std::pair<int, int>> nodes;
    const auto mask = node_mask(std::vector<Segment>{crack}, grid);
    for (int n = 0; n < 121; ++n)
      if (mask[static_cast<std::size_t>(n)]) nodes.emplace_back(n % 11, n / 11);
    return nodes;
  };
  using Nodes = std::vector<std::pair<int, int>>;
  CHECK(held({0.21, 0.52, 0.58, 0.52}) == Nodes{{2, 5}, {3, 5}, {4, 5}, {5, 5}, {6, 5}});
  CHECK(held({0.3, 0.1, 0.3, 0.4}) == Nodes{{3, 1}, {3, 2}, {3, 3}, {3, 4}});
  CHECK(held({0.4, 0.7, 0.1, 0.5}) == Nodes{{1, 5}, {2, 6}, {3, 6}, {4, 7}});
  CHECK(held({0.9, 0.5, 1e9, 0.5}) == Nodes{{9, 5}, {10, 5}});
  CHECK(held({0.52, 0.52, 0.52, 0.52}) == Nodes{{5, 5}});
}

TEST_CASE("each seeding holds its own nodes, and only a seeded history holds none") {
  const std::vector<Segment> cracks{{0.21, 0.52, 0.58, 0.52}};
  const auto count = [](const std::vector<unsigned char>& bytes) { return std::count(bytes.begin(), bytes.end(), 1); };
  CHECK(count(held_mask(CrackSeeding::slot, cracks, grid)) == 10);
  CHECK(count(held_mask(CrackSeeding::nodes, cracks, grid)) == 5);
  CHECK(count(held_mask(CrackSeeding::history, cracks, grid)) == 0);
  CHECK(count(seeded_elements(CrackSeeding::history, cracks, grid)) == 4);
  CHECK(count(seeded_elements(CrackSeeding::slot, cracks, grid)) == 0);
}
