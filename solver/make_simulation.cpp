#include "solver/make_simulation.hpp"

#include <fmt/format.h>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "solver/break_watch.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "solver/through_crack_watch.hpp"

namespace fracfarm {
namespace {

constexpr std::uint64_t mesh_file_limit = std::uint64_t{1} << 30;  // bytes

fdem::MeshChoice mesh_choice(const Scene& scene) {
  fdem::MeshChoice choice{.width = scene.width,
                          .height = scene.height,
                          .element_size = scene.fdem.element_size,
                          .seed = scene.fdem.mesh_seed,
                          .cracks = scene.cracks,
                          .layers = {}};
  for (std::size_t i = 0; i + 1 < scene.layers.size(); ++i) choice.layers.push_back(scene.layers[i].below);
  return choice;
}

Result<fdem::MeshResult> mesh_of(const Scene& scene) {
  const FdemSettings& settings = scene.fdem;
  if (settings.mesh_file.empty()) return fdem::make_mesh(mesh_choice(scene));
  const Result<std::string> bytes = read_file(settings.mesh_file, mesh_file_limit);
  if (!bytes) return fail(Fault::bad_request, "fdem.mesh_file: " + bytes.error().message);
  if (const std::string digest = sha256_hex(*bytes); digest != settings.mesh_sha256)
    return fail(Fault::bad_request, fmt::format("fdem.mesh_file: {} has the SHA-256 {}, the scene asks for {}", settings.mesh_file, digest,
                                                settings.mesh_sha256));
  return fail(Fault::bad_request, "fdem.mesh_file: not read yet");
}

Result<MadeSimulation> on_a_mesh(const Scene& scene, const RunControl&) {
  Result<fdem::MeshResult> mesh = mesh_of(scene);
  if (!mesh) return tl::unexpected(mesh.error());
  MadeSimulation made;
  if (!*mesh) {
    made.rejected = mesh->error();
    return made;
  }
  return fail(Fault::bad_request, "method fdem has no solver yet");
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
