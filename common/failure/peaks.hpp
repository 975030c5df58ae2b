// Peaks of a sampled signal. The ends are never peaks; a flat top counts once, at its middle sample.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace fracfarm {

struct Peak {
  std::size_t index = 0;
  double prominence = 0.0;  // height above the higher of the two lowest points that part it from higher ground (or from the ends)
  double reach = 0.0;       // the most that the prominence can become as samples are added: itself where higher ground follows
};

// Every local maximum, in order. Linear in the number of samples.
std::vector<Peak> local_maxima(std::span<const double> values);

// What a peak's prominence has to be at least: `fraction` of the signal's range. 0 for an empty signal.
double prominence_needed(std::span<const double> values, double fraction);

// Those whose prominence is at least `fraction` of the signal's range; empty for a constant signal.
std::vector<std::size_t> prominent_peaks(std::span<const double> values, double fraction);

}  // namespace fracfarm
