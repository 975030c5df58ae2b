// What a run has produced so far: series, frames, failure watch, and the ledger's health. Saved with the state, so that a resumed run ends
// with the same record to the last bit.
#pragma once

#include <memory>

#include "solver/archive.hpp"
#include "solver/solve.hpp"
#include "solver/watch.hpp"

namespace fracfarm {

// A grid: one row every so many explicit steps or every implicit one, and one at the step of the stress drop, so that the series gives it
// to the step. A mesh: as many rows over the horizon, but none closer than so many seconds, each to the step. drop10 is read to a row.
inline constexpr long long explicit_steps_per_row = 4;
inline constexpr double mesh_rows = 4000.0, least_mesh_row_interval = 0.5e-6;  // s

class RunLog {
 public:
  RunLog(const Scene& scene, double dt, std::unique_ptr<Watch> watch);

  // After the step that made n: watch, row, frame where they are due. Errors: SOLVER_NUMERIC.
  Result<void> note(const Simulation& simulation, long long n);
  // The last instant becomes a row too. Errors: SOLVER_NUMERIC.
  Result<void> close(const Simulation& simulation, long long n);

  const Watch& watch() const { return *watch_; }
  const Series& series() const { return series_; }
  std::vector<Frame>& frames() { return frames_; }
  double peak_stress() const { return peak_stress_; }
  double worst_residual() const;  // largest |residual| over largest external work

  void save(ArchiveWriter& archive) const;
  bool load(ArchiveReader& archive);

 private:
  bool row_is_due(const Simulation& simulation, long long n) const;
  Result<void> add_row(const Simulation& simulation, long long n);
  Result<void> check_health(long long n) const;

  double dt_;
  double frame_interval_;
  long long steps_per_row_;
  bool on_a_mesh_;     // its mean stress is worked out for rows only
  bool keeps_ledger_;  // an unstable quasi-static jump sheds energy that no inertia takes up
  std::unique_ptr<Watch> watch_;
  Series series_;
  std::vector<Frame> frames_;
  std::uint64_t next_frame_ = 0;
  SampleRow last_;                // row before
  double peak_stress_ = 0.0;      // Pa, over every step of a grid, every row of a mesh
  double energy_at_start_ = 0.0;  // J/m, kinetic and elastic
  double largest_work_ = 0.0;     // J/m
  double largest_energy_ = 0.0;   // J/m
  double largest_residual_ = 0.0;
};

}  // namespace fracfarm
