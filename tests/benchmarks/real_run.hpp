// One run of the dataset, solved when the first benchmark asks for it: a PBX plate in tension, 128 x 128 nodes, a frame every 5 us.
#pragma once

#include <string>

#include "common/record/record.hpp"
#include "common/scene/scene.hpp"
#include "common/task/task.hpp"

namespace fracfarm::benchmarks {

struct RealRun {
  Task task;  // its scene as text, its key
  Scene scene;
  Summary summary;  // with the record's digest
  Record record;    // as the solver gives it, not yet rounded
  std::string bytes;
};

const Scene& real_scene();
const RealRun& real_run();

}  // namespace fracfarm::benchmarks
