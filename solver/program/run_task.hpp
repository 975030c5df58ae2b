// One task from scene text to a record on disk: what the one-shot command and the kept-alive child share.
#pragma once

#include "common/record/writer.hpp"
#include "common/scene/scene.hpp"
#include "common/task/task.hpp"
#include "solver/solve.hpp"

namespace fracfarm {

struct TaskEnd {
  bool stopped = false;  // a checkpoint was kept where the task has one; no record
  Summary summary;
};

using Progress = std::function<void(long long step, double time, double horizon)>;

// Solves and writes the record. Errors: BAD_REQUEST (scene), SOLVER_NUMERIC, OUT_OF_MEMORY, NODE_LOST, OUTPUT_BAD; never throws.
Result<TaskEnd> run_task(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress);

// All problems of a scene in one sentence.
std::string problems_text(const Problems& problems);

}  // namespace fracfarm
