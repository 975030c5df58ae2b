// The mesher's door: cracks in, an isotropic conforming triangulation out, or the reason why there is none. Knows nothing of time or
// stress.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "common/scene/scene.hpp"
#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::fdem {

struct MeshChoice {
  double width = 0.25, height = 0.25;  // m
  double element_size = 0.003;         // m, length of an edge
  std::uint64_t seed = 1;              // of the points inside
  std::vector<Segment> cracks;         // as drawn; repaired before meshing
  std::vector<double> layers;          // m, heights where the material changes: edges lie along them
};

// What the gate looked at, and what repair did.
struct MeshReport {
  double smallest_height = 0.0;  // m
  double smallest_angle = 0.0;   // degrees
  double area_error = 0.0;       // |sum of areas - width height| over width height
  int moved = 0, trimmed = 0, extended = 0, merged = 0;
  double seconds = 0.0;
};

struct MadeMesh {
  TriangleMesh mesh;
  std::vector<Segment> cracks;  // as meshed
  MeshReport report;
};

// A mesh, or one sentence that says why the gate refused it (value and limit): the run then ends REJECTED_INPUT.
using MeshResult = tl::expected<MadeMesh, std::string>;

inline constexpr double smallest_height_allowed = 0.4e-3 / 3e-3;  // of the element size

MeshResult make_mesh(const MeshChoice& choice);

// A user's mesh, Gmsh MSH 2.2 or 4.1 ASCII: 3-node triangles; cracks are edges that lie on the scene's segments. Same gate.
MeshResult read_msh(std::string_view bytes, const MeshChoice& choice);

}  // namespace fracfarm::fdem
