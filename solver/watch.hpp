// The failure watch of a run: through cracks and the candidate of the stress drop after every step, and the fields at both times.
#pragma once

#include <optional>
#include <vector>

#include "common/failure/failure.hpp"
#include "solver/archive.hpp"
#include "solver/simulation.hpp"

namespace fracfarm {

// Left to right where top or bottom is loaded, bottom to top where left or right is; both where nothing is.
std::vector<CrackDirection> watched_directions(const Scene& scene);

class FailureWatch {
 public:
  explicit FailureWatch(std::vector<CrackDirection> directions) : directions_(std::move(directions)) {}

  // After a step that ended at `time` (s): notes the first through crack and its field.
  void after_step(const GridSimulation& simulation, double time);
  // At a row of the series: keeps the field of the first row below a tenth of the largest row so far, and drops it when a larger row comes.
  void at_row(const GridSimulation& simulation, double mean_stress);

  // True where this mean stress would be the first below a tenth of the largest row: its step must be a row.
  bool drops_at(double mean_stress) const { return peak_ > 0.0 && psi_dropped_.empty() && mean_stress < stress_drop_fraction * peak_; }

  const std::optional<double>& through_crack() const { return through_crack_; }  // s
  const std::vector<float>& psi_through() const { return psi_through_; }
  const std::vector<float>& psi_dropped() const { return psi_dropped_; }  // empty: the stress never dropped

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  static bool reaches_both_sides(const GridSimulation& simulation, CrackDirection direction);
  bool is_through(const GridSimulation& simulation, CrackDirection direction);
  bool cracks_changed(const GridSimulation& simulation);

  std::vector<CrackDirection> directions_;
  std::optional<double> through_crack_;
  double peak_ = 0.0;  // Pa, largest row
  std::vector<float> psi_through_, psi_dropped_;
  std::vector<double> damage_;  // scratch
  std::vector<unsigned char> visited_;
  std::vector<unsigned char> cracked_, searched_;  // nodes now, and when a path was last looked for
};

}  // namespace fracfarm
