// The watch of a grid: through cracks after every step, the candidate of the stress drop, and the fields at both times.
#pragma once

#include <optional>
#include <vector>

#include "solver/crack_paths.hpp"
#include "solver/watch.hpp"

namespace fracfarm {

// Left to right where top or bottom is loaded, bottom to top where left or right is; both where nothing is.
std::vector<CrackDirection> watched_directions(const Scene& scene);

class ThroughCrackWatch final : public Watch {
 public:
  // The simulation stays with the caller and outlives the watch; its damage now, at t = 0 or at a restart.
  ThroughCrackWatch(const Scene& scene, const GridSimulation& simulation)
      : simulation_(simulation), directions_(watched_directions(scene)) {}

  void after_step(double time) override;
  // Keeps the field of the first row below a tenth of the largest row so far, and drops it when a larger row comes.
  void at_row(const Series& series) override;
  bool wants_row(double mean_stress) const override {
    return peak_ > 0.0 && psi_dropped_.empty() && mean_stress < stress_drop_fraction * peak_;
  }
  bool is_over(Stop stop, double) const override { return stop == Stop::failure && through_crack_; }

  std::vector<FailureTime> times(const Series& series) const override;
  std::vector<float> damage_at(std::string_view rule, const Series& series) const override;

  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive, const Series& series) override;

  // What a study asks, row by row.
  void note_stress(double mean_stress);
  const std::optional<double>& through_crack() const { return through_crack_; }  // s
  const std::vector<float>& psi_through() const { return psi_through_; }
  const std::vector<float>& psi_dropped() const { return psi_dropped_; }  // empty: the stress never dropped

 private:
  bool reaches_both_sides(CrackDirection direction) const;

  const GridSimulation& simulation_;
  std::vector<CrackDirection> directions_;
  std::optional<double> through_crack_;
  double peak_ = 0.0;               // Pa, largest row
  std::vector<float> psi_initial_;  // of the first row
  std::vector<float> psi_through_, psi_dropped_;
  CrackMarks marks_;
  CrackPaths paths_;  // of the marks
};

}  // namespace fracfarm
