// Points inside the body: random, no two closer than a share of the element size (Poisson discs), clear of the lines.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/fdem/mesh/crack_graph.hpp"

namespace fracfarm::fdem {

struct Spacing {
  double between;        // m, of free points
  double from_vertices;  // m, of the lines
  double from_edges;     // m
};
Spacing spacing_of(double element_size);

// In a random order of a grid's cells. What these darts leave open is filled at the centres of empty circles, once there are triangles.
std::vector<Vec> throw_points(double width, double height, const Spacing& spacing, const CrackGraph& lines, std::uint64_t seed);

}  // namespace fracfarm::fdem
