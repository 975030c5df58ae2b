// Which method runs a scene, on what grid or mesh, and what watches it.
#pragma once

#include "solver/solve.hpp"
#include "solver/watch.hpp"

namespace fracfarm {

// Either a simulation with its watch, or the reason why the scene is one that no mesh could be made of.
struct MadeSimulation {
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<Watch> watch;
  double dt = 0.0;  // s, as the scene asks, before RunControl::step_scale
  std::string rejected;
  std::map<std::string, double> stages;  // seconds of making a mesh and what stands on it
};

// Errors: BAD_REQUEST where the scene's mesh file cannot be read or is another one.
Result<MadeSimulation> make_simulation(const Scene& scene, const RunControl& control);

}  // namespace fracfarm
