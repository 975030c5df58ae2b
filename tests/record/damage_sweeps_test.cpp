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

TEST_CASE("a joint may be at 2 but at nothing else outside 0...1, wherever it stands") {
  std::vector<float> damage = ramp();
  damage[5] = -0.0f, damage[6] = 2.0f;
  CHECK(in_joint_range(damage));
  CHECK(joint_excursion(damage) == 0.0f);
  for (float value : {std::nextafter(1.0f, 2.0f), std::nextafter(2.0f, 1.0f), std::nextafter(2.0f, 3.0f), -1e-9f, std::nanf(""), infinity})
    for (std::size_t place = 0; place < damage.size(); ++place) {
      std::vector<float> harmed = ramp();
      harmed[place] = value;
      REQUIRE_FALSE(in_joint_range(harmed));
    }
  damage[8] = 1.25f;
  CHECK(joint_excursion(damage) == 0.25f);
  damage[9] = 1.5f, damage[10] = std::nanf("");
  CHECK(joint_excursion(damage) == 0.5f);
  damage[548] = -0.75f;
  CHECK(joint_excursion(damage) == 0.75f);
}

TEST_CASE("contradictions between a field and its cracks or break times are counted, wherever they stand") {
  std::vector<float> damage = ramp();  // the last is 1
  std::vector<unsigned char> cracks(damage.size(), 0);
  std::vector<std::int32_t> broken_from(damage.size(), 9);
  broken_from.back() = 4;
  CHECK(count_crack_contradictions(damage, cracks) == 0);
  CHECK(count_break_contradictions(damage, broken_from, 4) == 0);
  CHECK(count_break_contradictions(damage, broken_from, 3) == 1);
  CHECK(count_break_contradictions(damage, broken_from, 9) == damage.size() - 1);
  for (std::size_t place = 0; place + 1 < damage.size(); ++place) {
    std::vector<float> harmed = damage;
    harmed[place] = 2.0f;
    REQUIRE(count_crack_contradictions(harmed, cracks) == 1);
    harmed[place] = 1.0f;
    REQUIRE(count_break_contradictions(harmed, broken_from, 4) == 1);
    cracks[place] = 1;
    REQUIRE(count_crack_contradictions(damage, cracks) == 1);
    cracks[place] = 0;
  }
}
