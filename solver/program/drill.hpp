// Rehearsal jobs (method "drill"): what goes wrong on a farm, on purpose and in a solver's place. Nothing is simulated.
#pragma once

#include "solver/program/run_task.hpp"

namespace fracfarm {

// Works for the scene's seconds, then does its act where this attempt is one that acts, else writes a sound record of nothing. Acts that end
// the process, or that never end, do not return. Errors: BAD_REQUEST for `leak` where no memory limit would stop it; those of writing.
Result<TaskEnd> run_drill(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress);

}  // namespace fracfarm
