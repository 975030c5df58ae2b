#include "solver/watch.hpp"

#include <algorithm>

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
bool FailureWatch::reaches_both_sides(const GridSimulation& simulation, CrackDirection direction) {
  const bool across = direction == CrackDirection::left_right;
  return simulation.crack_reaches(across ? Side::left : Side::bottom, through_crack_threshold) &&
         simulation.crack_reaches(across ? Side::right : Side::top, through_crack_threshold);
}

bool FailureWatch::is_through(const GridSimulation& simulation, CrackDirection direction) {
  if (!reaches_both_sides(simulation, direction)) return false;
  simulation.copy_damage(damage_);
  visited_.resize(damage_.size());
  return joins_sides({damage_, simulation.columns(), simulation.rows()}, through_crack_threshold, direction, visited_);
}

// The same cracked nodes give the same answer as a step ago.
bool FailureWatch::cracks_changed(const GridSimulation& simulation) {
  simulation.mark_cracked(through_crack_threshold, cracked_);
  if (cracked_ == searched_) return false;
  searched_ = cracked_;
  return true;
}

void FailureWatch::after_step(const GridSimulation& simulation, double time) {
  if (through_crack_) return;
  const auto reaches = [&](CrackDirection direction) { return reaches_both_sides(simulation, direction); };
  if (std::none_of(directions_.begin(), directions_.end(), reaches) || !cracks_changed(simulation)) return;
  for (const CrackDirection direction : directions_) {
    if (!is_through(simulation, direction)) continue;
    through_crack_ = time;
    psi_through_ = simulation.stored_damage();
    return;
  }
}

void FailureWatch::at_row(const GridSimulation& simulation, double mean_stress) {
  if (mean_stress > peak_) {
    peak_ = mean_stress;
    psi_dropped_.clear();
  } else if (drops_at(mean_stress)) {
    psi_dropped_ = simulation.stored_damage();
  }
}

void FailureWatch::save(ArchiveWriter& archive) const {
  archive.put(through_crack_.has_value());
  archive.put(through_crack_.value_or(0.0));
  archive.put(peak_);
  archive.put_array(psi_through_);
  archive.put_array(psi_dropped_);
}

void FailureWatch::load(ArchiveReader& archive) {
  const bool through = archive.get<bool>();
  const double time = archive.get<double>();
  if (through) through_crack_ = time;
  peak_ = archive.get<double>();
  archive.get_array(psi_through_);
  archive.get_array(psi_dropped_);
}

}  // namespace fracfarm
