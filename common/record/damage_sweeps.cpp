#include "common/record/damage_sweeps.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

namespace fracfarm {
namespace {

constexpr std::uint32_t one_bits = 0x3f800000, exponent_bits = 0x7f800000;

}  // namespace

// Floats of [0, 1] are ordered as their bits are, and every other one but -0 has larger bits.
bool in_unit_range(std::span<const float> psi) {
  std::uint32_t outside = 0;
  for (float value : psi) outside |= std::bit_cast<std::uint32_t>(value) > one_bits ? 1u : 0u;
  return !outside || std::all_of(psi.begin(), psi.end(), [](float value) { return value >= 0.0f && value <= 1.0f; });
}

std::size_t count_not_finite(std::span<const float> psi) {
  std::uint32_t count = 0;
  for (float value : psi) count += (std::bit_cast<std::uint32_t>(value) & exponent_bits) == exponent_bits ? 1u : 0u;
  return count;
}

float excursion(std::span<const float> psi) {
  float worst = 0.0f;
  for (float value : psi)
    if (!(value >= 0.0f && value <= 1.0f)) worst = std::max({worst, -value, value - 1.0f});
  return worst;
}

// Sixteen maxima side by side: one alone would wait for itself.
float largest_drop(std::span<const float> before, std::span<const float> after) {
  assert(before.size() == after.size());
  constexpr std::size_t lanes = 16;
  std::array<float, lanes> worst{};
  const std::size_t whole = before.size() / lanes * lanes;
  for (std::size_t i = 0; i < whole; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) {
      const float drop = before[i + k] - after[i + k];
      worst[k] = drop > worst[k] ? drop : worst[k];
    }
  for (std::size_t i = whole; i < before.size(); ++i) worst[0] = std::max(worst[0], before[i] - after[i]);
  return *std::max_element(worst.begin(), worst.end());
}

}  // namespace fracfarm
