// Lossy storage of damage: fewer bits, so that it compresses. Rounding is monotone: what did not heal does not heal after it.
#pragma once

#include <span>

namespace fracfarm {

// Stored damage is a multiple of 2^-13: within 2^-14 of the value, 0 and 1 exact. Not 2^-12: its multiple next to the through-crack
// threshold lies below it, and would hide a path of damage just above.
inline constexpr int psi_fraction_bits = 13;

// Rounds values in [0, 1] to the nearest multiple of 2^-psi_fraction_bits, ties to even. All others stay as they are, for the validator to
// find.
void round_damage(std::span<float> values);

// The same for the joints of a mesh, where exactly 1 means broken: what is below 1 stays below, at most 1 - 2^-psi_fraction_bits.
void round_joint_damage(std::span<float> values);

}  // namespace fracfarm
