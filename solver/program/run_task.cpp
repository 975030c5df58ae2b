#include "solver/program/run_task.hpp"

#include <fmt/format.h>

#include <new>

#include "solver/program/drill.hpp"
#include "solver/program/outcome.hpp"
#include "solver/program/signals.hpp"

namespace fracfarm {
namespace {

Result<TaskEnd> solve_and_write(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress) {
  if (scene.method == Method::drill) return run_drill(task, scene, keeping, progress);
  RunControl control;
  control.checkpoint = task.checkpoint;
  control.checkpoint_key = task.key;
  control.wall_budget_s = task.wall_budget_s;
  control.stop = &stop_requested();
  control.progress = progress;
  control.step_scale = task.step_scale;
  control.threads = task.threads;
  Result<RunResult> result = solve(scene, control);
  if (!result) return tl::unexpected(result.error());
  if (result->stopped) return TaskEnd{true, {}};
  TaskEnd end{false, summary_of(*result)};
  if (result->judgement.verdict == Verdict::rejected) return end;  // nothing ran: there is no record
  const Result<std::string> digest = write_record(record_of(task, scene, std::move(*result)), task.output, keeping);
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
                scene.method == Method::fdem
                    ? fmt::format("no memory for a mesh of elements of {:.3g} m", scene.fdem.element_size)
                    : fmt::format("no memory for a grid of {} x {} cells", scene.phase_field.cells_x, scene.phase_field.cells_z));
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
