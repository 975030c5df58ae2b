#include "common/record/damage_sweeps.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using namespace fracfarm;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// 549 values: whole blocks and vectors, and a rest of both.
std::vector<float> ramp() {
  std::vector<float> psi;
  for (int i = 0; i < 549; ++i) psi.push_back(static_cast<float>(i) / 548.0f);
  return psi;
}

}  // namespace

TEST_CASE("0, 1, minus 0 and the smallest number are in range, everything beside is not, wherever it stands") {
  std::vector<float> psi = ramp();
  psi[5] = -0.0f, psi[6] = std::numeric_limits<float>::denorm_min();
  CHECK(in_unit_range(psi));
  for (float value : {std::nextafter(1.0f, 2.0f), -std::numeric_limits<float>::denorm_min(), std::nanf(""), infinity, -infinity})
    for (std::size_t place = 0; place < psi.size(); ++place) {
      std::vector<float> harmed = ramp();
      harmed[place] = value;
      REQUIRE_FALSE(in_unit_range(harmed));
    }
}

TEST_CASE("values that are not finite are counted") {
  std::vector<float> psi = ramp();
  CHECK(count_not_finite(psi) == 0);
  psi[0] = std::nanf(""), psi[20] = -std::nanf(""), psi[36] = infinity, psi[35] = -infinity, psi[1] = std::numeric_limits<float>::max();
  CHECK(count_not_finite(psi) == 4);
}

TEST_CASE("the excursion is the largest distance from 0...1") {
  std::vector<float> psi = ramp();
  CHECK(excursion(psi) == 0.0f);
  psi[3] = 1.25f;
  CHECK(excursion(psi) == 0.25f);
  psi[36] = -0.5f, psi[7] = std::nanf("");
  CHECK(excursion(psi) == 0.5f);
}

TEST_CASE("the largest drop is found wherever it stands, and growth is none") {
  const std::vector<float> before = ramp();
  for (std::size_t place = 1; place < before.size(); ++place) {
    std::vector<float> after = before;
    for (float& value : after) value += 0.125f;
    REQUIRE(largest_drop(before, after) == 0.0f);
    after[place] = 0.5f * before[place];
    REQUIRE(largest_drop(before, after) == before[place] - after[place]);
  }
}
