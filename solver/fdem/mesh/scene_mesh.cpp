#include "solver/fdem/mesh/scene_mesh.hpp"

#include <fmt/format.h>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"

namespace fracfarm::fdem {
namespace {

constexpr std::uint64_t mesh_file_limit = std::uint64_t{1} << 30;  // bytes

}  // namespace

MeshChoice mesh_choice(const Scene& scene) {
  MeshChoice choice{scene.width, scene.height, scene.fdem.element_size, scene.fdem.mesh_seed, scene.cracks, {}};
  for (std::size_t i = 0; i + 1 < scene.layers.size(); ++i) choice.layers.push_back(scene.layers[i].below);
  return choice;
}

Result<MeshResult> mesh_of(const Scene& scene) {
  const FdemSettings& settings = scene.fdem;
  if (settings.mesh_file.empty()) return make_mesh(mesh_choice(scene));
  const Result<std::string> bytes = read_file(settings.mesh_file, mesh_file_limit);
  if (!bytes) return fail(Fault::bad_request, "fdem.mesh_file: " + bytes.error().message);
  if (const std::string digest = sha256_hex(*bytes); digest != settings.mesh_sha256)
    return fail(Fault::bad_request, fmt::format("fdem.mesh_file: {} has the SHA-256 {}, the scene asks for {}", settings.mesh_file, digest,
                                                settings.mesh_sha256));
  return read_msh(*bytes, mesh_choice(scene));
}

}  // namespace fracfarm::fdem
