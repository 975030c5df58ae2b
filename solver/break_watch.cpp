#include "solver/break_watch.hpp"

#include <algorithm>

namespace fracfarm {

void BreakWatch::feed(const Series& series, std::size_t row) {
  pick_.add({series["step_time"][row], series["stress_zz"][row], series["total_stress"][row], series["kinetic_energy"][row]});
}

void BreakWatch::at_row(const Series& series) {
  feed(series, series.rows() - 1);
  changes_.clear();
  simulation_.take_damage_changes(changes_);
  if (history_.rows() == 0)
    history_.add(simulation_.stored_damage());
  else
    history_.add_changes(changes_);
}

bool BreakWatch::is_over(Stop stop, double time) const {
  if (stop == Stop::drop10) return pick_.drop10() && time >= run_on_after_drop * *pick_.drop10();
  return stop == Stop::failure && pick_.settled();
}

std::vector<FailureTime> BreakWatch::times(const Series&) const {
  const std::vector<double> broke = simulation_.break_time();
  return {{"drop10", of_broken_body(pick_.drop10(), broke)}, {"five_step", of_broken_body(pick_.five_step(), broke)}};
}

std::vector<float> BreakWatch::damage_at(std::string_view rule, const Series& series) const {
  for (const FailureTime& candidate : times(series)) {
    if (candidate.rule != rule || !candidate.time) continue;
    const auto time = series["step_time"];
    const auto row = std::lower_bound(time.begin(), time.end(), *candidate.time) - time.begin();
    return history_.at(std::min(static_cast<std::size_t>(row), history_.rows() - 1));
  }
  return {};
}

void BreakWatch::save(ArchiveWriter& archive) const { history_.save(archive); }

void BreakWatch::load(ArchiveReader& archive, const Series& series) {
  history_.load(archive);
  if (history_.rows() != series.rows()) archive.reject();
  if (archive.failed()) return;
  for (std::size_t row = 0; row < series.rows(); ++row) feed(series, row);
}

}  // namespace fracfarm
