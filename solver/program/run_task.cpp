#include "solver/program/run_task.hpp"

#include <fmt/format.h>

#include <new>

#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "solver/boundary.hpp"
#include "solver/program/provenance.hpp"
#include "solver/program/signals.hpp"

namespace fracfarm {
namespace {

// The dataset's two load cases by name, anything else is the scene's own.
std::string boundary_condition(const Scene& scene) {
  if (!scene.sample) return "scene";
  for (const NamedLoad& load : named_loads)
    if (load.name == scene.sample->load) return std::string(load.name);
  return "scene";
}

Record make_record(const Task& task, const Scene& scene, RunResult& result) {
  Record record;
  record.key = task.key;
  record.canonical_scene = canonical_text(scene);
  record.method = name_of(scene.method);
  record.material = material_name(scene);
  record.boundary_condition = boundary_condition(scene);
  if (scene.sample) record.sample_id = scene.sample->id, record.pattern_seed = scene.sample->seed;
  record.judgement = result.judgement;
  record.failure_times = result.times;
  record.peak_stress = result.peak_stress;
  record.cracks = scene.cracks;
  record.phase_field = {std::move(result.x),           std::move(result.z),           {}, {}, std::move(result.psi_initial),
                        std::move(result.psi_failure), std::move(result.mask_initial)};
  for (Frame& frame : result.frames) {
    record.phase_field.time.push_back(frame.time);
    record.phase_field.psi.push_back(std::move(frame.psi));
  }
  record.series = std::move(result.series);
  record.energy_residual = result.energy_residual;
  record.provenance = provenance_of(scene, result, {task.attempt, task.step_scale});
  return record;
}

Summary summarise(const RunResult& result) {
  Summary summary;
  summary.verdict = result.judgement.verdict;
  summary.time_to_failure = result.judgement.time_to_failure;
  summary.failure_rule = result.judgement.rule;
  for (const FailureTime& time : result.times) summary.times[time.rule] = time.time;
  summary.peak_stress = result.peak_stress;
  summary.steps = result.steps;
  summary.dt = result.dt;
  summary.energy_residual = result.energy_residual;
  summary.cpu_s = result.cpu_s;
  summary.wall_s = result.wall_s;
  summary.stages = result.stages;
  summary.kernel = result.kernel;
  return summary;
}

Result<TaskEnd> solve_and_write(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress) {
  RunControl control;
  control.checkpoint = task.checkpoint;
  control.checkpoint_key = task.key;
  control.wall_budget_s = task.wall_budget_s;
  control.stop = &stop_requested();
  control.progress = progress;
  control.step_scale = task.step_scale;
  Result<RunResult> result = solve(scene, control);
  if (!result) return tl::unexpected(result.error());
  if (result->stopped) return TaskEnd{true, {}};
  TaskEnd end{false, summarise(*result)};
  const Result<std::string> digest = write_record(make_record(task, scene, *result), task.output, keeping);
  if (!digest) return tl::unexpected(digest.error());
  end.summary.record_sha256 = *digest;
  return end;
}

}  // namespace

Result<TaskEnd> run_task(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress) {
  try {
    return solve_and_write(task, scene, keeping, progress);
  } catch (const std::bad_alloc&) {
    return fail(Fault::out_of_memory,
                fmt::format("no memory for a grid of {} x {} cells", scene.phase_field.cells_x, scene.phase_field.cells_z));
  } catch (const std::exception& error) {
    return fail(Fault::solver_crash, error.what());
  }
}

std::string problems_text(const Problems& problems) {
  std::string text = "the scene has mistakes:";
  for (const Problem& p : problems) text += fmt::format(" {} = {} (allowed: {});", p.key, p.value, p.limit);
  return text;
}

}  // namespace fracfarm
