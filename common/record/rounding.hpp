// Lossy storage of float fields: fewer mantissa bits, so that they compress. Rounding is monotone: what did not heal does not heal after
// it.
#pragma once

#include <span>

namespace fracfarm {

inline constexpr int psi_mantissa_bits = 12;  // relative error at most 2^-13; 0 and 1 are exact

// Rounds to the nearest float with `bits` explicit mantissa bits (of 23), ties to even. Values that are not finite stay as they are.
float keep_mantissa_bits(float value, int bits);  // 1 <= bits <= 22
void keep_mantissa_bits(std::span<float> values, int bits);

}  // namespace fracfarm
