// Places of triangles and joints in memory: neighbours in the body near each other.
#pragma once

#include <vector>

#include "solver/fdem/body.hpp"

namespace fracfarm::fdem {

// Triangles of one material after another, each along a Hilbert curve through their centres; -1 fills up blocks of `block`.
std::vector<int> triangle_order(const Body& body, int block);

}  // namespace fracfarm::fdem
