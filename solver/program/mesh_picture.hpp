// A mesh as a picture: edges, cracks, the flattest triangle, and its figures below.
#pragma once

#include "common/picture/canvas.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"

namespace fracfarm {

picture::Canvas draw_mesh(const fdem::MadeMesh& made, const fdem::MeshChoice& choice);

}  // namespace fracfarm
