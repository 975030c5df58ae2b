// The mesh that a scene asks for: made, or read from the scene's file.
#pragma once

#include "common/base/result.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"

namespace fracfarm::fdem {

// What of a scene the mesh depends on.
MeshChoice mesh_choice(const Scene& scene);

// BAD_REQUEST where scene.fdem.mesh_file cannot be read or has another digest than scene.fdem.mesh_sha256.
Result<MeshResult> mesh_of(const Scene& scene);

}  // namespace fracfarm::fdem
