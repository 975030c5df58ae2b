// Rules that hold for a record of any method: identity, order of times, the energy ledger, peak and judgement.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/record/content_rules.hpp"
#include "common/record/damage_sweeps.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm::content {
namespace {

double not_increasing(const std::vector<double>& times) {
  std::size_t count = !(times.front() >= 0.0);
  for (std::size_t i = 1; i < times.size(); ++i) count += !(times[i] > times[i - 1]);
  return static_cast<double>(count);
}

double largest(const Series& series, std::string_view name) {
  double worst = 0.0;
  for (double value : series[name]) worst = std::max(worst, std::abs(value));
  return worst;
}

// What an energy error is measured by: the most that the loads brought, or that was there where they bring little.
double energy_scale(const Series& series) {
  const auto kinetic = series["kinetic_energy"], elastic = series["elastic_energy"];
  double most = largest(series, "external_work");
  for (std::size_t row = 0; row < series.rows(); ++row) most = std::max(most, kinetic[row] + elastic[row]);
  return most;
}

double share(double part, double whole) { return part == 0.0 ? 0.0 : whole > 0.0 ? part / whole : infinity; }

}  // namespace

std::size_t count_not_finite(std::span<const double> values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }));
}

double series_not_finite(const Context& c) {
  std::size_t count = count_not_finite(std::array{c.record.peak_stress, c.record.energy_residual, c.record.judgement.confidence});
  for (const Column& column : c.record.series.columns) count += count_not_finite(column.values);
  return static_cast<double>(count);
}

double frame_times(const Context& c, const std::vector<double>& time) {
  if (!c.scene) return infinity;
  const auto rows = c.record.series["step_time"];
  double gap = 0.0;  // at least one time step: the last one may reach past the horizon
  for (std::size_t i = 1; i < rows.size(); ++i) gap = std::max(gap, rows[i] - rows[i - 1]);
  const bool starts = time.front() == 0.0, ends = time.back() <= c.scene->horizon * (1.0 + 1e-9) + gap;
  return not_increasing(time) + !starts + !ends;
}

double series_times(const Context& c) { return not_increasing(c.record.series.find("step_time")->values); }

double scene_differences(const Context& c) {
  if (!c.scene) return infinity;
  const Record& r = c.record;
  const auto& sample = c.scene->sample;
  return !(canonical_text(*c.scene) == r.canonical_scene) + !(name_of(c.scene->method) == r.method) +
         !(material_name(*c.scene) == r.material) + !((sample ? sample->load : "scene") == r.boundary_condition) +
         !((sample ? sample->id : 0) == r.sample_id) + !((sample ? sample->seed : 0) == r.pattern_seed) + !(c.scene->cracks == r.cracks);
}

double wrong_key(const Context& c) {
  const auto build = c.record.provenance.find("build_id");
  return build == c.record.provenance.end() || job_key(c.record.canonical_scene, build->second) != c.record.key;
}

// A quasi-static run is exempt: in an unstable jump there is no inertia that would take up the energy.
double open_ledger(const Context& c) {
  if (c.scene && c.scene->phase_field.integrator == Integrator::quasi_static) return 0.0;
  const Series& s = c.record.series;
  const auto time = s["step_time"], residual = s["energy_residual"];
  const Column* dt = s.find("dt");
  double worst = 0.0;
  for (std::size_t row = 0; row < s.rows(); ++row)
    worst = std::max(worst, std::abs(residual[row]) * (dt ? ledger_weight(time[row] / dt->values[row]) : 1.0));
  return share(worst, energy_scale(s));
}

// The stored energy_residual is measured by the external work alone, and 0 where there was none.
double residual_difference(const Context& c) {
  const double work = largest(c.record.series, "external_work");
  return std::abs(c.record.energy_residual - (work > 0.0 ? largest(c.record.series, "energy_residual") / work : 0.0));
}

// energies - work - residual is what was there at the start, so it may not change from row to row.
double wrong_ledger(const Context& c) {
  static constexpr std::array<std::string_view, 8> held{"kinetic_energy",  "elastic_energy", "released_energy", "plastic_energy",
                                                        "fracture_energy", "viscous_energy", "contact_energy",  "friction_energy"};
  const Series& s = c.record.series;
  double low = infinity, high = -infinity;
  for (std::size_t row = 0; row < s.rows(); ++row) {
    double start = -s["external_work"][row] - s["energy_residual"][row];
    for (std::string_view name : held)
      if (const Column* column = s.find(name)) start += column->values[row];
    low = std::min(low, start);
    high = std::max(high, start);
  }
  return share(high - low, energy_scale(s));
}

// How far the stored peak lies from the series' own, which is sampled: at or above it, and not farther than the stress ever moves from row
// to row. Waves cross a body of fewer than eight cells between two rows, and a body may break before the second one: the series may then
// miss any peak.
double peak_difference(const Context& c, double cells) {
  const auto stress = c.record.series["stress_zz"];
  const double seen = std::max(0.0, *std::max_element(stress.begin(), stress.end()));
  if (seen > c.record.peak_stress * (1.0 + 1e-12)) return infinity;
  if (cells < 8.0 || stress.size() < 4) return 0.0;
  double jump = 0.0;
  for (std::size_t row = 1; row < stress.size(); ++row) jump = std::max(jump, std::abs(stress[row] - stress[row - 1]));
  return share(std::max(0.0, c.record.peak_stress - seen - jump), c.record.peak_stress);
}

// The field at the failure counts among the frames where its time is known.
double largest_healing(const Context& c, const DamageHistory& damage) {
  float worst = 0.0f;
  const std::vector<float>* before = &damage.initial;
  for (const auto& frame : damage.frames) worst = std::max(worst, largest_drop(*std::exchange(before, &frame), frame));
  const double at = c.record.judgement.time_to_failure.value_or(infinity);
  const auto next = std::upper_bound(damage.time.begin(), damage.time.end(), at) - damage.time.begin();
  if (next > 0) worst = std::max(worst, largest_drop(damage.frames[static_cast<std::size_t>(next - 1)], damage.failure));
  if (next < std::ssize(damage.frames))
    worst = std::max(worst, largest_drop(damage.failure, damage.frames[static_cast<std::size_t>(next)]));
  return worst;
}

const FailureTime* candidate(const Record& record, std::string_view rule) {
  for (const FailureTime& time : record.failure_times)
    if (time.rule == rule) return &time;
  return nullptr;
}

// Between a stored candidate and the same criterion on the stored series, s.
double seconds_apart(const Context& c, std::string_view rule, const std::optional<double>& again) {
  const FailureTime* stored = candidate(c.record, rule);
  if (!stored) return 0.0;
  if (stored->time.has_value() != again.has_value()) return infinity;
  return again ? std::abs(*stored->time - *again) : 0.0;
}

double judgement_differences(const Context& c) {
  const Judgement& stored = c.record.judgement;
  const Judgement again = judge(c.record.method, c.record.failure_times, stored.rule);
  return !(stored.verdict == again.verdict) + !(stored.time_to_failure == again.time_to_failure) + !(stored.rule == again.rule) +
         !(stored.confidence == again.confidence);
}

}  // namespace fracfarm::content
