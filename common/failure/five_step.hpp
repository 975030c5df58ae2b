// The five steps of the pick one by one, for who must know which peaks it stands on. The pick itself is five_step() in failure.hpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace fracfarm {

// From one row to the next.
struct Drop {
  std::size_t row = 0;  // the upper one
  double rate = 0.0;    // J/(m s); 0 where nothing falls
};

struct KeyPeak {
  std::size_t row = 0;
  Drop drop;  // the steepest from it to the next peak
};

struct FiveSteps {
  std::optional<KeyPeak> key;              // step 3, of the kinetic energy
  std::optional<std::size_t> stress_peak;  // step 4
  std::optional<std::size_t> pick;         // step 5
};

FiveSteps five_steps(std::span<const double> time, std::span<const double> total_stress, std::span<const double> kinetic_energy);

}  // namespace fracfarm
