#include "common/record/rounding.hpp"

namespace fracfarm {

void round_damage(std::span<float> values) {
  constexpr float coarse = 1 << (23 - psi_fraction_bits);  // floats from here to its double lie 2^-psi_fraction_bits apart
  for (float& value : values) {
    const float rounded = (value + coarse) - coarse;
    value = value >= 0.0f && value <= 1.0f ? rounded : value;
  }
}

}  // namespace fracfarm
