// The seed paper's automated picking routine, step by step as its Methodology states it. What the text leaves open is fixed here and said
// at the step; the result is one candidate beside the others, never the only word.
#include "common/failure/five_step.hpp"

#include <algorithm>
#include <cassert>

#include "common/failure/failure.hpp"
#include "common/failure/peaks.hpp"

namespace fracfarm {
namespace {

using Signal = std::span<const double>;

// Fastest fall between two samples from a peak to the next one (or the end of the run). Not the mean slope down to the valley:
// a long quiet tail after the collapse would hide it.
Drop drop_after(Signal time, Signal energy, std::size_t peak, std::size_t next) {
  Drop steepest;
  for (std::size_t i = peak; i + 1 < next; ++i) {
    const double rate = (energy[i] - energy[i + 1]) / (time[i + 1] - time[i]);
    if (rate > steepest.rate) steepest = {i, rate};
  }
  return steepest;
}

// Step 3: the kinetic energy peak with the steepest drop after it; the first of equals.
std::optional<KeyPeak> key_peak(Signal time, Signal energy, const std::vector<std::size_t>& peaks) {
  std::optional<KeyPeak> key;
  double steepest = 0.0;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const Drop drop = drop_after(time, energy, peaks[i], i + 1 < peaks.size() ? peaks[i + 1] : energy.size());
    if (drop.rate > steepest) key = KeyPeak{peaks[i], drop}, steepest = drop.rate;
  }
  return key;
}

// Step 5: the first sample from `start` on where the forward gradient is no longer negative after it was.
std::optional<std::size_t> end_of_fall(Signal stress, std::size_t start) {
  bool falling = false;
  for (std::size_t i = start; i + 1 < stress.size(); ++i) {
    const bool falls = stress[i + 1] < stress[i];
    if (falling && !falls) return i;
    falling = falls;
  }
  return std::nullopt;
}

}  // namespace

FiveSteps five_steps(Signal time, Signal total_stress, Signal kinetic_energy) {
  assert(time.size() == total_stress.size() && time.size() == kinetic_energy.size());  // step 1: both signals at each step
  FiveSteps steps;
  const std::vector<std::size_t> stress_peaks = prominent_peaks(total_stress, peak_prominence);  // step 2
  const std::vector<std::size_t> energy_peaks = prominent_peaks(kinetic_energy, peak_prominence);
  steps.key = key_peak(time, kinetic_energy, energy_peaks);
  if (!steps.key) return steps;
  const auto next = std::upper_bound(stress_peaks.begin(), stress_peaks.end(), steps.key->row);  // step 4: the first one after it
  if (next == stress_peaks.end()) return steps;
  steps.stress_peak = *next;
  steps.pick = end_of_fall(total_stress, *next);
  return steps;
}

std::optional<double> five_step(Signal time, Signal total_stress, Signal kinetic_energy) {
  const std::optional<std::size_t> pick = five_steps(time, total_stress, kinetic_energy).pick;
  return pick ? std::optional(time[*pick]) : std::nullopt;
}

}  // namespace fracfarm
