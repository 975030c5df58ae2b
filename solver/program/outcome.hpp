// What leaves a run: the record for the file, the summary for whoever asked.
#pragma once

#include "common/record/record.hpp"
#include "common/task/task.hpp"
#include "solver/solve.hpp"

namespace fracfarm {

Record record_of(const Task& task, const Scene& scene, RunResult result);
Summary summary_of(const RunResult& result);  // the record's digest is still empty

}  // namespace fracfarm
