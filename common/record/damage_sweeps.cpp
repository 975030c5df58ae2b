#include "common/record/damage_sweeps.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "common/record/vector_paths.hpp"

namespace fracfarm {
namespace {

constexpr std::uint32_t one_bits = 0x3f800000, exponent_bits = 0x7f800000, two_bits = 0x40000000;

// Floats of [0, 1] are ordered as their bits are, and every other one but -0 has larger bits.
FRACFARM_VECTOR_PATHS std::uint32_t has_larger_bits(const float* psi, std::size_t count) {
  std::uint32_t larger = 0;
  for (std::size_t i = 0; i < count; ++i) larger |= std::bit_cast<std::uint32_t>(psi[i]) > one_bits ? 1u : 0u;
  return larger;
}

FRACFARM_VECTOR_PATHS std::uint32_t has_no_joint_value(const float* damage, std::size_t count) {
  std::uint32_t other = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(damage[i]);
    other |= (bits > one_bits ? 1u : 0u) & (bits != two_bits ? 1u : 0u);
  }
  return other;
}

FRACFARM_VECTOR_PATHS std::uint32_t unlike_cracks(const float* damage, const unsigned char* is_crack, std::size_t count) {
  std::uint32_t unlike = 0;
  for (std::size_t i = 0; i < count; ++i) unlike += (damage[i] == 2.0f ? 1u : 0u) ^ (is_crack[i] ? 1u : 0u);
  return unlike;
}

FRACFARM_VECTOR_PATHS std::uint32_t unlike_breaks(const float* damage, const std::int32_t* broken_from, std::int32_t frame,
                                                  std::size_t count) {
  std::uint32_t unlike = 0;
  for (std::size_t i = 0; i < count; ++i) unlike += (damage[i] == 1.0f ? 1u : 0u) ^ (broken_from[i] <= frame ? 1u : 0u);
  return unlike;
}

FRACFARM_VECTOR_PATHS std::uint32_t drops(const float* before, const float* after, std::size_t count) {
  std::uint32_t lower = 0;
  for (std::size_t i = 0; i < count; ++i) lower |= before[i] > after[i] ? 1u : 0u;
  return lower;
}

}  // namespace

bool in_unit_range(std::span<const float> psi) {
  return !has_larger_bits(psi.data(), psi.size()) ||
         std::all_of(psi.begin(), psi.end(), [](float value) { return value >= 0.0f && value <= 1.0f; });
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

bool in_joint_range(std::span<const float> damage) {
  return !has_no_joint_value(damage.data(), damage.size()) ||
         std::all_of(damage.begin(), damage.end(), [](float value) { return (value >= 0.0f && value <= 1.0f) || value == 2.0f; });
}

float joint_excursion(std::span<const float> damage) {
  float worst = 0.0f;
  for (float value : damage)
    if (value < 0.0f || value > 1.0f) worst = std::max(worst, std::min(std::abs(value - 2.0f), std::max(-value, value - 1.0f)));
  return worst;
}

std::size_t count_crack_contradictions(std::span<const float> damage, std::span<const unsigned char> is_crack) {
  assert(damage.size() == is_crack.size());
  return unlike_cracks(damage.data(), is_crack.data(), damage.size());
}

std::size_t count_break_contradictions(std::span<const float> damage, std::span<const std::int32_t> broken_from, std::int32_t frame) {
  assert(damage.size() == broken_from.size());
  return unlike_breaks(damage.data(), broken_from.data(), frame, damage.size());
}

// Most of a field drops nowhere; how far costs more to find than whether.
float largest_drop(std::span<const float> before, std::span<const float> after) {
  assert(before.size() == after.size());
  constexpr std::size_t block = 256;
  float worst = 0.0f;
  for (std::size_t first = 0; first < before.size(); first += block) {
    const std::size_t end = std::min(first + block, before.size());
    if (!drops(before.data() + first, after.data() + first, end - first)) continue;
    for (std::size_t i = first; i < end; ++i)
      if (before[i] > after[i]) worst = std::max(worst, before[i] - after[i]);
  }
  return worst;
}

}  // namespace fracfarm
