#include "solver/program/outcome.hpp"

#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "solver/program/provenance.hpp"

namespace fracfarm {
namespace {

// The dataset's two load cases by name, anything else is the scene's own.
std::string boundary_condition(const Scene& scene) {
  if (!scene.sample) return "scene";
  for (const NamedLoad& load : named_loads)
    if (load.name == scene.sample->load) return std::string(load.name);
  return "scene";
}

void fill_frames(Record& record, GridLayout& grid, RunResult& result) {
  PhaseFieldFrames& frames = record.phase_field;
  frames = {std::move(grid.x),   std::move(grid.z), {}, {}, std::move(result.damage_initial), std::move(result.damage_failure),
            std::move(grid.mask)};
  for (Frame& frame : result.frames) {
    frames.time.push_back(frame.time);
    frames.psi.push_back(std::move(frame.damage));
  }
}

void fill_frames(Record& record, MeshLayout& layout, RunResult& result) {
  FdemFrames& frames = record.fdem;
  frames = {
      std::move(layout.mesh),      {}, {}, std::move(result.damage_initial), std::move(result.damage_failure), std::move(layout.break_time),
      std::move(layout.break_mode)};
  for (Frame& frame : result.frames) {
    frames.time.push_back(frame.time);
    frames.damage.push_back(std::move(frame.damage));
  }
}

}  // namespace

Record record_of(const Task& task, const Scene& scene, RunResult result) {
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
  std::visit([&](auto& layout) { fill_frames(record, layout, result); }, result.layout);
  record.series = std::move(result.series);
  record.energy_residual = result.energy_residual;
  record.provenance = provenance_of(scene, result, {task.attempt, task.step_scale});
  return record;
}

Summary summary_of(const RunResult& result) {
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

}  // namespace fracfarm
