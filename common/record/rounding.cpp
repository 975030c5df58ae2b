#include "common/record/rounding.hpp"

#include "common/record/vector_paths.hpp"

namespace fracfarm {
namespace {

constexpr float coarse = 1 << (23 - psi_fraction_bits);  // floats from here to its double lie 2^-psi_fraction_bits apart

FRACFARM_VECTOR_PATHS void round_each(float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float value = values[i], rounded = (value + coarse) - coarse;
    values[i] = value >= 0.0f && value <= 1.0f ? rounded : value;
  }
}

constexpr float below_one = 1.0f - 1.0f / (1 << psi_fraction_bits);

FRACFARM_VECTOR_PATHS void round_each_joint(float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float value = values[i], rounded = (value + coarse) - coarse, kept = rounded < below_one ? rounded : below_one;
    values[i] = value >= 0.0f && value < 1.0f ? kept : value;
  }
}

}  // namespace

void round_joint_damage(std::span<float> values) { round_each_joint(values.data(), values.size()); }
void round_damage(std::span<float> values) { round_each(values.data(), values.size()); }

}  // namespace fracfarm
