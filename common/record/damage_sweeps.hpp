// Sweeps over whole fields of damage for the rules of the content: once over every frame for the writer, once more for the validator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fracfarm {

bool in_unit_range(std::span<const float> psi);            // every value in [0, 1], so none that is not a number
std::size_t count_not_finite(std::span<const float> psi);  // infinities and not-a-number
float excursion(std::span<const float> psi);               // largest distance from [0, 1]; not-a-number has none

// The same for the joints of a mesh, where 2 stands for an initial crack: in [0, 1], or 2.
bool in_joint_range(std::span<const float> damage);
float joint_excursion(std::span<const float> damage);  // largest distance from [0, 1] and from 2

// Of one field, by edge: values that are 2 where `is_crack` is 0, or are not where it is 1; values that are 1 where `broken_from` is past
// `frame`, or are not where it is not.
std::size_t count_crack_contradictions(std::span<const float> damage, std::span<const unsigned char> is_crack);
std::size_t count_break_contradictions(std::span<const float> damage, std::span<const std::int32_t> broken_from, std::int32_t frame);

// Largest drop from `before` to `after`, of the same size; 0 where nothing drops.
float largest_drop(std::span<const float> before, std::span<const float> after);

}  // namespace fracfarm
