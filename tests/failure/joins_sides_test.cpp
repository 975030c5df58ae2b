// Fields are drawn as text, top row first, '#' for an open crack.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/failure/failure.hpp"

namespace {

using namespace fracfarm;

struct Drawn {
  std::vector<double> values;
  int columns = 0, rows = 0;

  explicit Drawn(const std::vector<std::string>& top_first)
      : columns(static_cast<int>(top_first.front().size())), rows(static_cast<int>(top_first.size())) {
    for (auto row = top_first.rbegin(); row != top_first.rend(); ++row)
      for (char c : *row) values.push_back(c == '#' ? 1.0 : c == '+' ? 0.9 : 0.0);
  }
  bool joins(CrackDirection direction) const {
    std::vector<unsigned char> visited;
    return joins_sides({values, columns, rows}, through_crack_threshold, direction, visited);
  }
  bool left_right() const { return joins(CrackDirection::left_right); }
  bool bottom_top() const { return joins(CrackDirection::bottom_top); }
};

}  // namespace

TEST_CASE("a straight row joins left and right but not bottom and top") {
  const Drawn field({"....", "####", "...."});
  CHECK(field.left_right());
  CHECK_FALSE(field.bottom_top());
}

TEST_CASE("a straight column joins bottom and top but not left and right") {
  const Drawn field({".#..", ".#..", ".#.."});
  CHECK(field.bottom_top());
  CHECK_FALSE(field.left_right());
}

TEST_CASE("diagonal neighbours are joined") {
  CHECK(Drawn({"...#", "..#.", ".#..", "#..."}).left_right());
  CHECK(Drawn({"#...", ".#..", "..#.", "...#"}).bottom_top());
}

TEST_CASE("one missing node parts the sides") {
  CHECK_FALSE(Drawn({"##.##", ".....", "....."}).left_right());
  CHECK_FALSE(Drawn({"##..#", "..#..", "....."}).bottom_top());
}

TEST_CASE("a node at the threshold itself is not open") { CHECK_FALSE(Drawn({"##+##"}).left_right()); }

TEST_CASE("a path that turns back on itself is followed") {
  const Drawn field({"####.", "...#.", ".###.", ".#...", ".####"});
  CHECK(field.left_right());
}

TEST_CASE("cracks from both sides that overlap without touching do not join") {
  CHECK_FALSE(Drawn({"####..", "......", "..####"}).left_right());
}

TEST_CASE("scratch of an earlier field does not leak into the next") {
  const Drawn open({"####", "...."}), closed({"#.##", "...."});
  std::vector<unsigned char> visited;
  REQUIRE(joins_sides({open.values, 4, 2}, 0.9, CrackDirection::left_right, visited));
  CHECK_FALSE(joins_sides({closed.values, 4, 2}, 0.9, CrackDirection::left_right, visited));
}

TEST_CASE("a random field agrees with a transitive closure") {
  std::vector<unsigned char> visited;
  unsigned state = 12345;
  int joined = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int columns = 6, rows = 5;
    std::vector<double> values(30);
    for (double& v : values) v = ((state = state * 1664525u + 1013904223u) >> 16) % 100 < 45 ? 1.0 : 0.0;
    std::vector<int> label(30);  // smallest node of the component, by repeated relaxation
    for (int i = 0; i < 30; ++i) label[static_cast<std::size_t>(i)] = i;
    for (int pass = 0; pass < 30; ++pass)
      for (int a = 0; a < 30; ++a)
        for (int b = 0; b < 30; ++b)
          if (values[static_cast<std::size_t>(a)] > 0.9 && values[static_cast<std::size_t>(b)] > 0.9 &&
              std::abs(a % columns - b % columns) <= 1 && std::abs(a / columns - b / columns) <= 1)
            label[static_cast<std::size_t>(a)] = std::min(label[static_cast<std::size_t>(a)], label[static_cast<std::size_t>(b)]);
    bool expected = false;
    for (int a = 0; a < 30; a += columns)
      for (int b = columns - 1; b < 30; b += columns)
        expected |= values[static_cast<std::size_t>(a)] > 0.9 && values[static_cast<std::size_t>(b)] > 0.9 &&
                    label[static_cast<std::size_t>(a)] == label[static_cast<std::size_t>(b)];
    joined += expected;
    REQUIRE(joins_sides({values, columns, rows}, 0.9, CrackDirection::left_right, visited) == expected);
  }
  CHECK(joined > 40);  // both answers were asked for
  CHECK(joined < 360);
}
