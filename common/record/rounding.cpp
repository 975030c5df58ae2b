#include "common/record/rounding.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace fracfarm {

float keep_mantissa_bits(float value, int bits) {
  if (!std::isfinite(value)) return value;
  const int dropped = 23 - bits;
  std::uint32_t word = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t half = (1u << dropped) / 2u, odd = word >> dropped & 1u;
  word += half - 1u + odd;  // a carry runs into the exponent, which is the next float up
  return std::bit_cast<float>(word & ~((1u << dropped) - 1u));
}

void keep_mantissa_bits(std::span<float> values, int bits) {
  for (float& value : values) value = keep_mantissa_bits(value, bits);
}

}  // namespace fracfarm
