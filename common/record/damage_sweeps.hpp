// Sweeps over whole fields of damage for the rules of the content: once over every frame for the writer, once more for the validator.
#pragma once

#include <cstddef>
#include <span>

namespace fracfarm {

bool in_unit_range(std::span<const float> psi);            // every value in [0, 1], so none that is not a number
std::size_t count_not_finite(std::span<const float> psi);  // infinities and not-a-number
float excursion(std::span<const float> psi);               // largest distance from [0, 1]; not-a-number has none

// Largest drop from `before` to `after`, of the same size; 0 where nothing drops.
float largest_drop(std::span<const float> before, std::span<const float> after);

}  // namespace fracfarm
