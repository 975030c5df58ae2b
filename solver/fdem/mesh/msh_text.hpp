// Gmsh's MSH files, ASCII: 2.2 and 4.1 in, 2.2 out. Knows the grammar alone; what the mesh must be is read_msh's. Any bytes are safe to
// read: memory stays within some times the file's size.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::fdem {

struct MshContent {
  std::vector<std::array<double, 3>> nodes;
  std::vector<std::array<int, 3>> triangles;     // places in nodes
  std::vector<std::pair<int, int>> crack_edges;  // two-node lines of the physical group "cracks"
  bool names_cracks = false;                     // there is such a group
};

// Errors: one sentence with the line.
tl::expected<MshContent, std::string> parse_msh(std::string_view bytes);

// MSH 2.2: the body as physical surface "body", crack edges as physical curve "cracks"; reading it gives the same mesh to the bit.
std::string write_msh(const TriangleMesh& mesh);

}  // namespace fracfarm::fdem
