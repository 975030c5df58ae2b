// The door of FDEM: a scene with its mesh, or a specimen of any shape, becomes a simulation for the time loop.
#pragma once

#include <memory>

#include "solver/fdem/body.hpp"
#include "solver/rules.hpp"
#include "solver/simulation.hpp"

namespace fracfarm {

// `threads`: of one run; the bits do not depend on them. `mesh` fits the scene's rectangle; edges along which materials change lie on the
// layers.
std::unique_ptr<MeshSimulation> make_fdem(const Scene& scene, TriangleMesh mesh, const Rules& rules = {}, int threads = 1);

namespace fdem {

// What the scene says about its mesh: materials, loads on its sides, fields at t = 0.
Body body_of(const Scene& scene, TriangleMesh mesh);

// float or double as the settings or their tier say.
std::unique_ptr<MeshSimulation> make_fdem(Body body, const FdemSettings& settings, const Rules& rules = {}, int threads = 1);

}  // namespace fdem
}  // namespace fracfarm
