#include "solver/through_crack_watch.hpp"

#include <algorithm>

#include "common/failure/new_crack.hpp"
#include "solver/boundary.hpp"

namespace fracfarm {

std::vector<CrackDirection> watched_directions(const Scene& scene) {
  const bool vertical = is_loaded(scene, Side::top) || is_loaded(scene, Side::bottom);
  const bool horizontal = is_loaded(scene, Side::left) || is_loaded(scene, Side::right);
  std::vector<CrackDirection> directions;
  if (vertical || !horizontal) directions.push_back(CrackDirection::left_right);
  if (horizontal || !vertical) directions.push_back(CrackDirection::bottom_top);
  return directions;
}

// A path needs a cracked node on both sides.
bool ThroughCrackWatch::reaches_both_sides(CrackDirection direction) const {
  const bool across = direction == CrackDirection::left_right;
  return simulation_.crack_reaches(across ? Side::left : Side::bottom, through_crack_threshold) &&
         simulation_.crack_reaches(across ? Side::right : Side::top, through_crack_threshold);
}

void ThroughCrackWatch::after_step(double time) {
  if (through_crack_) return;
  if (std::none_of(directions_.begin(), directions_.end(), [&](CrackDirection direction) { return reaches_both_sides(direction); })) return;
  simulation_.mark_cracked(through_crack_threshold, marks_);
  if (marks_.changed.empty()) return;
  paths_.update(simulation_.columns(), simulation_.rows(), marks_.cracked, marks_.changed);
  if (std::none_of(directions_.begin(), directions_.end(), [&](CrackDirection direction) { return paths_.join(direction); })) return;
  through_crack_ = time;
  psi_through_ = simulation_.stored_damage();
}

void ThroughCrackWatch::at_row(const Series& series) {
  if (psi_initial_.empty()) psi_initial_ = simulation_.stored_damage();
  note_stress(series["stress_zz"].back());
}

void ThroughCrackWatch::note_stress(double mean_stress) {
  if (mean_stress > peak_) {
    peak_ = mean_stress;
    psi_dropped_.clear();
  } else if (wants_row(mean_stress)) {
    psi_dropped_ = simulation_.stored_damage();
  }
}

// A body that only rings loses its mean stress, too: without a new crack that is no failure.
std::vector<FailureTime> ThroughCrackWatch::times(const Series& series) const {
  const auto time = series["step_time"];
  const std::optional<double> drop =
      has_new_crack(psi_dropped_, psi_initial_) ? stress_drop(time, series["stress_zz"]) : std::optional<double>{};
  return {{"through_crack", through_crack_},
          {"stress_drop", drop},
          {"five_step", five_step(time, series["total_stress"], series["kinetic_energy"])}};
}

std::vector<float> ThroughCrackWatch::damage_at(std::string_view rule, const Series&) const {
  return rule == "through_crack" ? psi_through_ : rule == "stress_drop" ? psi_dropped_ : std::vector<float>{};
}

void ThroughCrackWatch::save(ArchiveWriter& archive) const {
  archive.put(through_crack_.has_value());
  archive.put(through_crack_.value_or(0.0));
  archive.put(peak_);
  archive.put_array(psi_initial_);
  archive.put_array(psi_through_);
  archive.put_array(psi_dropped_);
}

void ThroughCrackWatch::load(ArchiveReader& archive, const Series&) {
  const bool through = archive.get<bool>();
  const double time = archive.get<double>();
  if (through) through_crack_ = time;
  peak_ = archive.get<double>();
  archive.get_array(psi_initial_);
  archive.get_array(psi_through_);
  archive.get_array(psi_dropped_);
}

}  // namespace fracfarm
