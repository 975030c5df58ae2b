#include "common/failure/failure_pick.hpp"

#include <algorithm>
#include <cmath>

#include "common/failure/failure.hpp"
#include "common/failure/five_step.hpp"
#include "common/failure/peaks.hpp"

namespace fracfarm {
namespace {

// A peak that is not prominent yet but can become so while the range stays as it is, between the key peak and its steepest drop: it would
// be the key. One before a prominent peak cannot: what parts the prominent one from higher ground would long have parted it, too. For the
// same reason none can between the key peak and the stress peak.
bool has_rival(const FiveSteps& steps, std::span<const double> kinetic_energy) {
  const double needed = prominence_needed(kinetic_energy, peak_prominence);
  const std::vector<Peak> peaks = local_maxima(kinetic_energy);
  return std::any_of(peaks.begin(), peaks.end(), [&](const Peak& peak) {
    const bool between = peak.index > steps.key->row && peak.index <= steps.key->drop.row;
    return between && peak.prominence < needed && peak.reach >= needed;
  });
}

bool is_firm(const FiveSteps& steps, std::span<const double> kinetic_energy) { return steps.pick && !has_rival(steps, kinetic_energy); }

}  // namespace

bool firm_pick(std::span<const double> time, std::span<const double> total_stress, std::span<const double> kinetic_energy) {
  return is_firm(five_steps(time, total_stress, kinetic_energy), kinetic_energy);
}

void FailurePick::add(const SeriesRow& row) {
  time_.push_back(row.time);
  total_stress_.push_back(row.total_stress);
  kinetic_energy_.push_back(row.kinetic_energy);
  if (row.mean_stress > highest_stress_) highest_stress_ = row.mean_stress, drop10_.reset();
  if (highest_stress_ > 0.0 && !drop10_ && row.mean_stress < stress_drop_fraction * highest_stress_) drop10_ = row.time;
  if (!settled_ && drop10_ && time_.size() >= next_look_ && row.time >= next_look_time_) look();
}

std::optional<double> FailurePick::five_step() const { return fracfarm::five_step(time_, total_stress_, kinetic_energy_); }

void FailurePick::look() {
  const FiveSteps steps = five_steps(time_, total_stress_, kinetic_energy_);
  if (!is_firm(steps, kinetic_energy_)) return look_again_later();
  const double since = time_[quiet_since(*steps.pick, steps.key->drop.rate)];
  next_look_time_ = since + settling_.wait * time_[*steps.pick];
  if (time_.back() >= next_look_time_) settled_ = time_.back();
}

void FailurePick::look_again_later() { next_look_ = time_.size() + std::max<std::size_t>(4, time_.size() / 64); }

// The pick, or the last row after it that was loud.
std::size_t FailurePick::quiet_since(std::size_t pick, double rate) const {
  double largest = 0.0;
  for (double stress : total_stress_) largest = std::max(largest, std::abs(stress));
  for (std::size_t row = time_.size() - 1; row > pick; --row) {
    const double fall = (kinetic_energy_[row - 1] - kinetic_energy_[row]) / (time_[row] - time_[row - 1]);
    if (fall > settling_.quiet * rate || std::abs(total_stress_[row]) > settling_.quiet * largest) return row;
  }
  return pick;
}

}  // namespace fracfarm
