// The door and the one time loop: start or resume, step, note, stop. Knows criteria, budgets and checkpoints, and no equations.
#include "solver/solve.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "solver/checkpoint.hpp"
#include "solver/make_simulation.hpp"
#include "solver/run_log.hpp"

namespace fracfarm {
namespace {

constexpr double progress_interval_s = 0.5;
constexpr double checkpoint_interval_s = 300.0;  // a killed run loses at most this much

enum class End { none, failure, horizon, wall_clock, step_budget, stopped };

// Of this run: a study has others on other threads, a run with threads of its own is all that its process does.
double cpu_now_s(const RunControl& control) { return control.threads > 1 ? process_cpu_s() : thread_cpu_s(); }

// When a run began, before its mesh was made.
struct Begin {
  double wall_s, cpu_s;
};

class Run {
 public:
  Run(const Scene& scene, const RunControl& control, MadeSimulation made, Begin begin)
      : scene_(scene),
        control_(control),
        begin_(begin),
        making_(std::move(made.stages)),
        simulation_(std::move(made.simulation)),
        dt_(control.step_scale * made.dt),
        last_step_(std::max(1LL, static_cast<long long>(std::ceil(scene.horizon / dt_ - 1e-9)))),
        log_(scene, dt_, std::move(made.watch)) {}

  Result<RunResult> go() {
    if (auto begun = resume_or_start(); !begun) return tl::unexpected(begun.error());
    End end = why_end();
    while (end == End::none) {
      if (auto stepped = simulation_->step(n_, dt_); !stepped) return numeric_trouble(stepped.error());
      ++n_;
      if (auto noted = log_.note(*simulation_, n_); !noted) return tl::unexpected(noted.error());
      tell_progress();
      if (auto kept = checkpoint_now_and_then(); !kept) return tl::unexpected(kept.error());
      end = why_end();
    }
    return finish(end);
  }

 private:
  Result<void> resume_or_start() {
    const Result<bool> resumed = resume();
    if (!resumed) return tl::unexpected(resumed.error());
    if (*resumed) return {};
    if (auto started = simulation_->start(dt_); !started) return numeric_trouble(started.error());
    damage_initial_ = simulation_->stored_damage();
    return log_.note(*simulation_, 0);
  }

  End why_end() {
    if (log_.watch().is_over(scene_.stop, static_cast<double>(n_) * dt_)) return End::failure;
    if (n_ >= last_step_) return End::horizon;
    if (control_.stop && control_.stop->load(std::memory_order_relaxed)) return End::stopped;
    if (elapsed_s() >= control_.wall_budget_s) return End::wall_clock;
    if (control_.step_budget && n_ - first_step_ >= *control_.step_budget) return End::step_budget;
    return End::none;
  }

  Result<RunResult> finish(End end) {
    RunResult result;
    result.stopped = end == End::stopped;
    if (end == End::stopped || end == End::wall_clock || end == End::step_budget) {
      if (auto saved = save(); !saved) return tl::unexpected(saved.error());
    } else if (!control_.checkpoint.empty()) {
      std::error_code ignored;
      std::filesystem::remove(control_.checkpoint, ignored);
    }
    if (result.stopped) return result;
    if (auto closed = log_.close(*simulation_, n_); !closed) return tl::unexpected(closed.error());
    fill(result, end == End::wall_clock ? "wall_clock" : end == End::step_budget ? "step_budget" : "horizon");
    return result;
  }

  void fill(RunResult& result, std::string_view otherwise) {
    const Series& series = log_.series();
    result.times = log_.watch().times(series);
    result.judgement = judge(name_of(scene_.method), result.times, otherwise);
    result.peak_stress = log_.peak_stress();
    result.layout = simulation_->layout();
    result.damage_initial = damage_initial_;
    result.damage_failure = log_.watch().damage_at(result.judgement.rule, series);
    if (result.damage_failure.empty()) result.damage_failure = simulation_->stored_damage();
    result.frames = std::move(log_.frames());
    result.series = series;
    result.steps = n_, result.dt = dt_;
    result.energy_residual = log_.worst_residual();
    result.cpu_s = cpu_before_s_ + cpu_now_s(control_) - begin_.cpu_s;
    result.wall_s = wall_before_s_ + elapsed_s();
    result.stages = simulation_->stage_seconds();
    result.stages.insert(making_.begin(), making_.end());
    result.kernel = simulation_->kernel();
  }

  // Whose checkpoint it is: the job, the build and the step size; any of them changes the numbers.
  std::string identity() const { return fmt::format("{} {} {}", control_.checkpoint_key, build_info().build_id, shortest(dt_)); }

  Result<void> save() {
    last_save_s_ = elapsed_s();
    if (control_.checkpoint.empty()) return {};
    ArchiveWriter archive;
    archive.put(n_);
    archive.put(cpu_before_s_ + cpu_now_s(control_) - begin_.cpu_s);
    archive.put(wall_before_s_ + elapsed_s());
    archive.put_array(damage_initial_);
    simulation_->save(archive);
    log_.save(archive);
    return write_checkpoint(control_.checkpoint, identity(), archive.bytes());
  }

  // False where there is nothing to resume from; the simulation and the log are then as new.
  Result<bool> resume() {
    if (control_.checkpoint.empty()) return false;
    const CheckpointRead read = read_checkpoint(control_.checkpoint, identity());
    if (read.payload && load(*read.payload)) return true;
    if (!read.note.empty() || read.payload)
      fmt::print(stderr, "note: {}\n", read.payload ? "checkpoint ignored: its contents do not fit the scene" : read.note);
    if (read.payload)
      if (auto again = begin_anew(); !again) return tl::unexpected(again.error());
    return false;
  }

  bool load(std::string_view payload) {
    ArchiveReader archive(payload);
    n_ = archive.get<long long>();
    cpu_before_s_ = archive.get<double>();
    wall_before_s_ = archive.get<double>();
    archive.get_array(damage_initial_);
    first_step_ = n_;
    return n_ >= 0 && simulation_->load(archive, n_, dt_) && log_.load(archive) && archive.finished();
  }

  // A checkpoint that does not fit may have filled half of what is here.
  Result<void> begin_anew() {
    Result<MadeSimulation> made = make_simulation(scene_, control_);
    if (!made) return tl::unexpected(made.error());
    simulation_ = std::move(made->simulation);
    log_ = RunLog(scene_, dt_, std::move(made->watch));
    n_ = first_step_ = 0, cpu_before_s_ = wall_before_s_ = 0.0;
    return {};
  }

  Result<void> checkpoint_now_and_then() { return elapsed_s() - last_save_s_ < checkpoint_interval_s ? Result<void>{} : save(); }

  void tell_progress() {
    if (!control_.progress || elapsed_s() - last_progress_s_ < progress_interval_s) return;
    last_progress_s_ = elapsed_s();
    control_.progress(n_, static_cast<double>(n_) * dt_, scene_.horizon);
  }

  tl::unexpected<Error> numeric_trouble(const Error& error) const {
    return fail(error.fault, fmt::format("{}; at step {}, {:.6g} s, dt {:.6g} s", error.message, n_, static_cast<double>(n_) * dt_, dt_));
  }

  double elapsed_s() { return clock_.monotonic_s() - begin_.wall_s; }

  const Scene& scene_;
  const RunControl& control_;
  SystemClock clock_;
  const Begin begin_;
  const std::map<std::string, double> making_;  // seconds before the first step
  std::unique_ptr<Simulation> simulation_;
  double dt_;
  long long last_step_;
  RunLog log_;
  long long n_ = 0;           // steps made
  long long first_step_ = 0;  // of this attempt
  std::vector<float> damage_initial_;
  double cpu_before_s_ = 0.0, wall_before_s_ = 0.0;  // of the attempts that this one resumed
  double last_progress_s_ = 0.0, last_save_s_ = 0.0;
};

RunResult rejected_run(const std::string& reason) {
  RunResult result;
  result.judgement.verdict = Verdict::rejected;
  result.judgement.rule = reason;
  return result;
}

Result<RunResult> run_once(const Scene& scene, const RunControl& control) {
  const Begin begin{SystemClock().monotonic_s(), cpu_now_s(control)};
  Result<MadeSimulation> made = make_simulation(scene, control);
  if (!made) return tl::unexpected(made.error());
  if (!made->simulation) return rejected_run(made->rejected);
  return Run(scene, control, std::move(*made), begin).go();
}

// What is tried next after SOLVER_NUMERIC, in words; nothing where the scene does not let it or all was tried.
std::optional<std::string_view> try_otherwise(int trials, Scene& scene, RunControl& control) {
  if (scene.method == Method::fdem) {
    if (trials == 0) return control.step_scale *= 0.5, "half the step";
    if (trials > 1 || scene.fdem.tier == FdemTier::reference) return std::nullopt;
    scene.fdem.tier = FdemTier::reference;
    scene.fdem.precision.reset(), scene.fdem.penalty.reset(), scene.fdem.dt.reset();
    return "the reference tier";
  }
  if (scene.phase_field.step_control != StepControl::adaptive || trials == step_halvings) return std::nullopt;
  control.step_scale *= 0.5;
  return "half the step";
}

}  // namespace

Result<RunResult> solve(const Scene& scene, const RunControl& control) {
  SystemClock clock;
  const double start_s = clock.monotonic_s(), start_cpu_s = cpu_now_s(control);
  Scene trial_scene = scene;
  RunControl trial = control;
  std::vector<std::string> notes;
  for (;;) {
    const double before_s = clock.monotonic_s() - start_s, before_cpu_s = cpu_now_s(control) - start_cpu_s;
    trial.wall_budget_s = control.wall_budget_s - before_s;
    Result<RunResult> result = run_once(trial_scene, trial);
    if (result) {
      result->cpu_s += before_cpu_s, result->wall_s += before_s;
      result->notes = std::move(notes);
      return result;
    }
    if (result.error().fault != Fault::solver_numeric) return result;
    const auto next = try_otherwise(static_cast<int>(notes.size()), trial_scene, trial);
    if (!next) return result;
    notes.push_back(fmt::format("begun again with {} after: {}", *next, result.error().message));
  }
}

}  // namespace fracfarm
