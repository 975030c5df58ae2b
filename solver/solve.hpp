// The solver's door: a scene in, everything that a record needs out. Knows no network, no ledger and no HDF5.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/failure/failure.hpp"
#include "common/failure/series.hpp"
#include "common/scene/scene.hpp"
#include "solver/rules.hpp"
#include "solver/simulation.hpp"

namespace fracfarm {

// What must not change a result: how long, where to keep a checkpoint, whom to tell.
struct RunControl {
  std::filesystem::path checkpoint;  // empty: none
  std::string checkpoint_key;        // a checkpoint of another key is ignored
  double wall_budget_s = 8.0 * 3600.0;
  std::optional<long long> step_budget;                                       // steps of this attempt; ends like the wall budget
  const std::atomic<bool>* stop = nullptr;                                    // set by SIGTERM: save and end
  std::function<void(long long step, double time, double horizon)> progress;  // called about twice a second
  Rules rules;                                                                // all on but in a study
  int threads = 1;                                                            // of an FDEM run; never changes a result
  double step_scale = 1.0;                                                    // changes the result: 0.5 after SOLVER_NUMERIC
};

struct Frame {
  double time = 0.0;          // s
  std::vector<float> damage;  // by node of a grid, by edge of a mesh
};

// A rejected run has a judgement with the reason as its rule, and nothing else.
struct RunResult {
  bool stopped = false;  // by RunControl::stop; a checkpoint was saved and nothing below counts
  Judgement judgement;
  std::vector<FailureTime> times;
  double peak_stress = 0.0;  // Pa, largest mean vertical stress over time
  std::vector<float> damage_initial, damage_failure;
  std::vector<Frame> frames;
  Series series;
  long long steps = 0;
  double dt = 0.0;               // s, of the last step
  double energy_residual = 0.0;  // largest |residual| over largest external work
  double cpu_s = 0.0, wall_s = 0.0;
  std::map<std::string, double> stages;  // seconds by stage
  std::string kernel;                    // ISA path and precision
  Layout layout;                         // where the values of the damage fields stand
  std::vector<std::string> notes;        // what happened on the way: trials of an adaptive run that ended SOLVER_NUMERIC
};

// A run that ends SOLVER_NUMERIC is begun again where its scene lets it: phase_field.step "adaptive" with half the step, at most
// step_halvings times; FDEM once with half the step, then in the reference tier. RunResult::notes says so.
inline constexpr int step_halvings = 4;

// Errors: SOLVER_NUMERIC with evidence (step, time, what was not finite or did not close), NODE_LOST where the checkpoint cannot be
// written.
Result<RunResult> solve(const Scene& scene, const RunControl& control);

}  // namespace fracfarm
