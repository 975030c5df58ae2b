// Watches a run for the criteria of its method: when it is over, its candidate times to failure, and the damage at each of them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "common/failure/failure.hpp"
#include "common/failure/series.hpp"
#include "solver/archive.hpp"
#include "solver/simulation.hpp"

namespace fracfarm {

class Watch {
 public:
  virtual ~Watch() = default;

  // After a step that ended at `time` (s).
  virtual void after_step(double time) = 0;
  // After a row was added to the series.
  virtual void at_row(const Series& series) = 0;
  // True where this step must be a row, so that the series gives a criterion to the step.
  virtual bool wants_row(double mean_stress) const = 0;
  // True where the criteria that the run stops by are met. s.
  virtual bool is_over(Stop stop, double time) const = 0;

  virtual std::vector<FailureTime> times(const Series& series) const = 0;
  // Damage at the time that the rule gave; empty where the watch kept none: then it is that of the last instant.
  virtual std::vector<float> damage_at(std::string_view rule, const Series& series) const = 0;

  virtual void save(ArchiveWriter& archive) const = 0;
  // `series` is what was saved with it.
  virtual void load(ArchiveReader& archive, const Series& series) = 0;
};

}  // namespace fracfarm
