#include "solver/crack_paths.hpp"

#include <catch2/catch.hpp>

#include "common/base/random.hpp"

using namespace fracfarm;

namespace {

bool joins(const std::vector<unsigned char>& cracked, int columns, int rows, CrackDirection direction) {
  const std::vector<double> values(cracked.begin(), cracked.end());
  std::vector<unsigned char> visited;
  return joins_sides({values, columns, rows}, 0.5, direction, visited);
}

}  // namespace

TEST_CASE("crack paths kept node by node are those that a search finds, while nodes crack and now and then heal") {
  RandomStream random(2026, 3, 0);
  int joined = 0, apart = 0, healed = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const int columns = 3 + trial % 7, rows = 4 + trial % 5;
    std::vector<unsigned char> cracked(static_cast<std::size_t>(columns * rows), 0);
    CrackPaths paths;
    for (int step = 0; step < 60; ++step) {
      std::vector<int> changed;
      for (int k = 0; k < 2; ++k) {  // of different halves
        const int node = k * (columns * rows / 2) + static_cast<int>(random.uniform() * (columns * rows / 2));
        const bool heals = cracked[static_cast<std::size_t>(node)] && random.uniform() < 0.3;
        if (cracked[static_cast<std::size_t>(node)] != !heals) changed.push_back(node);
        cracked[static_cast<std::size_t>(node)] = !heals;
        healed += heals;
      }
      paths.update(columns, rows, cracked, changed);
      for (const CrackDirection direction : {CrackDirection::left_right, CrackDirection::bottom_top}) {
        const bool expected = joins(cracked, columns, rows, direction);
        CHECK(paths.join(direction) == expected);
        ++(expected ? joined : apart);
      }
    }
  }
  CHECK(joined > 100);
  CHECK(apart > 100);
  CHECK(healed > 20);
}
