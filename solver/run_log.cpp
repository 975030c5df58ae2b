#include "solver/run_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fracfarm {
namespace {

// Frame k belongs to the step nearest to k intervals.
long long step_of_frame(std::uint64_t k, double interval, double dt) { return std::llround(static_cast<double>(k) * interval / dt); }

// Frames closer than steps: one instant is stored once. Frames closer than 1e-18 steps are not told apart.
std::uint64_t first_frame_after(long long n, double interval, double dt) {
  return static_cast<std::uint64_t>(std::min(std::ceil((static_cast<double>(n) + 0.5) * dt / interval), 1e18));
}

long long steps_per_row(const Scene& scene, double dt) {
  const double mesh_row_interval = std::max(least_mesh_row_interval, scene.horizon / mesh_rows);
  if (scene.method == Method::fdem) return std::max(1LL, std::llround(mesh_row_interval / dt));
  return scene.phase_field.integrator == Integrator::explicit_central ? explicit_steps_per_row : 1;
}

}  // namespace

RunLog::RunLog(const Scene& scene, double dt, std::unique_ptr<Watch> watch)
    : dt_(dt),
      frame_interval_(scene.frame_interval),
      steps_per_row_(steps_per_row(scene, dt)),
      on_a_mesh_(scene.method == Method::fdem),
      keeps_ledger_(scene.method == Method::fdem || scene.phase_field.integrator != Integrator::quasi_static),
      watch_(std::move(watch)),
      series_(empty_series(scene.method)) {}

Result<void> RunLog::note(const Simulation& simulation, long long n) {
  const double time = static_cast<double>(n) * dt_;
  if (!on_a_mesh_) peak_stress_ = std::max(peak_stress_, simulation.mean_stress_zz());
  if (n > 0) watch_->after_step(time);
  if (row_is_due(simulation, n))
    if (auto healthy = add_row(simulation, n); !healthy) return healthy;
  if (frame_interval_ > 0.0 && step_of_frame(next_frame_, frame_interval_, dt_) <= n) {
    frames_.push_back({time, simulation.stored_damage()});
    next_frame_ = std::max(next_frame_ + 1, first_frame_after(n, frame_interval_, dt_));
  }
  return {};
}

bool RunLog::row_is_due(const Simulation& simulation, long long n) const {
  return n % steps_per_row_ == 0 || (!on_a_mesh_ && watch_->wants_row(simulation.mean_stress_zz()));
}

Result<void> RunLog::add_row(const Simulation& simulation, long long n) {
  SampleRow sample = simulation.sample(n, dt_);
  const long long sweeps = sample.solver_iterations;
  sample.solver_iterations -= last_.solver_iterations;
  append(series_, sample);
  if (n == 0) energy_at_start_ = sample.kinetic_energy + sample.elastic_energy - sample.external_work;
  last_ = sample;
  last_.solver_iterations = sweeps;
  largest_work_ = std::max(largest_work_, std::abs(sample.external_work));
  largest_energy_ = std::max({largest_energy_, std::abs(sample.external_work), sample.kinetic_energy + sample.elastic_energy});
  largest_residual_ = std::max(largest_residual_, std::abs(sample.energy_residual));
  peak_stress_ = std::max(peak_stress_, sample.stress_zz);
  watch_->at_row(series_);
  return check_health(n);
}

// An FDEM run past its step's edge sheds the energy into broken joints, so that its ledger may close: what is free can still not be more
// than what was brought.
bool holds_more_than_brought(const SampleRow& s, double at_start) {
  return s.kinetic_energy + s.elastic_energy > at_start + 1.05 * s.external_work + 1e-6;
}

Result<void> RunLog::check_health(long long n) const {
  const SampleRow& s = last_;
  const double total = s.kinetic_energy + s.elastic_energy + s.released_energy + s.surface_energy + s.fracture_energy + s.viscous_energy +
                       s.contact_energy + s.friction_energy + s.external_work;
  if (!std::isfinite(total))
    return fail(Fault::solver_numeric,
                fmt::format("not finite at step {}, {:.6g} s: kinetic {:.4g}, elastic {:.4g}, released {:.4g}, external work {:.4g} J/m", n,
                            s.step_time, s.kinetic_energy, s.elastic_energy, s.released_energy, s.external_work));
  if (on_a_mesh_ && holds_more_than_brought(s, energy_at_start_))
    return fail(Fault::solver_numeric,
                fmt::format("more energy than was brought at step {}, {:.6g} s: kinetic {:.4g}, elastic {:.4g}, external work {:.4g} J/m; "
                            "dt {:.6g} s",
                            n, s.step_time, s.kinetic_energy, s.elastic_energy, s.external_work, dt_));
  if (keeps_ledger_ && std::abs(s.energy_residual) * ledger_weight(static_cast<double>(n)) > energy_residual_limit * largest_energy_)
    return fail(
        Fault::solver_numeric,
        fmt::format("the energy ledger is open at step {}, {:.6g} s: residual {:.4g} J/m of {:.4g} J/m, limit {:.0f} %; dt {:.6g} s", n,
                    s.step_time, s.energy_residual, largest_energy_, 100.0 * energy_residual_limit, dt_));
  return {};
}

Result<void> RunLog::close(const Simulation& simulation, long long n) {
  const bool stored = series_["step_time"].back() == static_cast<double>(n) * dt_;
  return stored ? Result<void>{} : add_row(simulation, n);
}

double RunLog::worst_residual() const { return largest_work_ > 0.0 ? largest_residual_ / largest_work_ : 0.0; }

void RunLog::save(ArchiveWriter& archive) const {
  for (const Column& column : series_.columns) archive.put_array(column.values);
  archive.put(static_cast<std::uint64_t>(frames_.size()));
  for (const Frame& frame : frames_) {
    archive.put(frame.time);
    archive.put_array(frame.damage);
  }
  watch_->save(archive);
  archive.put(next_frame_);
  archive.put(last_);
  for (const double value : {peak_stress_, energy_at_start_, largest_work_, largest_energy_, largest_residual_}) archive.put(value);
}

bool RunLog::load(ArchiveReader& archive) {
  for (Column& column : series_.columns) {
    archive.get_array(column.values);
    if (column.values.size() != series_.rows()) archive.reject();
  }
  const std::uint64_t count = archive.get<std::uint64_t>();
  for (std::uint64_t k = 0; k < count && !archive.failed(); ++k) {
    Frame frame{archive.get<double>(), {}};
    archive.get_array(frame.damage);
    if (!frames_.empty() && frame.damage.size() != frames_.front().damage.size()) archive.reject();
    frames_.push_back(std::move(frame));
  }
  watch_->load(archive, series_);
  next_frame_ = archive.get<std::uint64_t>();
  last_ = archive.get<SampleRow>();
  for (double* value : {&peak_stress_, &energy_at_start_, &largest_work_, &largest_energy_, &largest_residual_})
    *value = archive.get<double>();
  return !archive.failed();
}

}  // namespace fracfarm
