#include "common/record/rounding.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/failure/failure.hpp"

using namespace fracfarm;

namespace {

float rounded(float value) {
  std::vector<float> values{value};
  round_damage(values);
  return values.front();
}

}  // namespace

TEST_CASE("rounding keeps 0 and 1, is within 2^-14, monotone and the same when done again") {
  CHECK(rounded(0.0f) == 0.0f);
  CHECK(rounded(1.0f) == 1.0f);
  std::vector<float> values;
  for (float value = 1e-30f; value < 1.0f; value *= 1.0001f) values.push_back(value);
  std::vector<float> kept = values;
  round_damage(kept);
  for (std::size_t i = 0; i < values.size(); ++i) {
    REQUIRE(std::abs(kept[i] - values[i]) <= 1.0f / 16384.0f);
    REQUIRE(kept[i] * 8192.0f == std::nearbyint(values[i] * 8192.0f));  // scaling by a power of two is exact
    REQUIRE((i == 0 || kept[i] >= kept[i - 1]));
  }
  std::vector<float> again = kept;
  round_damage(again);
  CHECK(again == kept);
}

TEST_CASE("ties go to the even multiple") {
  const float unit = 1.0f / 8192.0f;
  CHECK(rounded(0.5f * unit) == 0.0f);
  CHECK(rounded(1.5f * unit) == 2.0f * unit);
}

TEST_CASE("values outside 0...1 stay as they are, to the last bit, for the validator to find") {
  for (float value : {-1e-9f, -0.3f, std::nextafter(1.0f, 2.0f), 7.0f, std::numeric_limits<float>::infinity(), std::nanf("")})
    CHECK(std::bit_cast<std::uint32_t>(rounded(value)) == std::bit_cast<std::uint32_t>(value));
}

TEST_CASE("a value above the through-crack threshold stays above it when rounded") {
  const float threshold = static_cast<float>(through_crack_threshold);
  for (float value = std::nextafter(threshold, 1.0f); value < threshold + 1e-3f; value = std::nextafter(value, 1.0f))
    REQUIRE(rounded(value) > through_crack_threshold);
}

TEST_CASE("a joint below 1 stays below 1, and 0, 1 and 2 are exact") {
  const auto joint = [](float value) {
    std::vector<float> values{value};
    round_joint_damage(values);
    return values.front();
  };
  for (float value : {0.0f, 1.0f, 2.0f}) CHECK(joint(value) == value);
  CHECK(joint(std::nextafter(1.0f, 0.0f)) == 1.0f - 1.0f / 8192.0f);
  float before = 0.0f;
  for (float value = 1e-30f; value < 1.0f; value *= 1.0001f) {
    const float kept = joint(value);
    REQUIRE(kept < 1.0f);
    REQUIRE(std::abs(kept - value) <= (value > 1.0f - 1.0f / 16384.0f ? 1.0f / 8192.0f : 1.0f / 16384.0f));
    REQUIRE(kept >= before);
    REQUIRE(joint(kept) == kept);
    before = kept;
  }
  for (float value : {-1e-9f, 1.5f, std::nextafter(2.0f, 3.0f), std::nanf("")})
    CHECK(std::bit_cast<std::uint32_t>(joint(value)) == std::bit_cast<std::uint32_t>(value));
}
