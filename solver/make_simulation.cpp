#include "solver/make_simulation.hpp"

#include "common/base/clock.hpp"
#include "solver/break_watch.hpp"
#include "solver/fdem/fdem.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "solver/through_crack_watch.hpp"

namespace fracfarm {
namespace {

Result<MadeSimulation> on_a_mesh(const Scene& scene, const RunControl& control) {
  SystemClock clock;
  const double begun_s = clock.monotonic_s();
  Result<fdem::MeshResult> mesh = fdem::mesh_of(scene);
  if (!mesh) return tl::unexpected(mesh.error());
  MadeSimulation made;
  const double meshed_s = clock.monotonic_s();
  if (!*mesh) {
    made.rejected = mesh->error();
    return made;
  }
  std::unique_ptr<MeshSimulation> simulation = make_fdem(scene, std::move((*mesh)->mesh), control.rules, control.threads);
  made.dt = scene.fdem.dt.value_or(scene.fdem.dt_fraction * simulation->stable_dt());
  made.watch = std::make_unique<BreakWatch>(*simulation);
  made.stages = {{"mesh", meshed_s - begun_s}, {"model", clock.monotonic_s() - meshed_s}};
  made.simulation = std::move(simulation);
  return made;
}

MadeSimulation on_a_grid(const Scene& scene, const RunControl& control) {
  std::unique_ptr<GridSimulation> simulation = make_phase_field(scene, control.rules);
  MadeSimulation made;
  made.dt = scene.phase_field.dt.value_or(scene.phase_field.cfl * simulation->stable_dt());
  made.watch = std::make_unique<ThroughCrackWatch>(scene, *simulation);
  made.simulation = std::move(simulation);
  return made;
}

}  // namespace

Result<MadeSimulation> make_simulation(const Scene& scene, const RunControl& control) {
  if (scene.method == Method::fdem) return on_a_mesh(scene, control);
  return on_a_grid(scene, control);
}

}  // namespace fracfarm
