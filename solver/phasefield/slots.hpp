// Cracks on the grid: the four nodes of every element that a segment crosses are held at psi = 1 ("slot" seeding).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "common/scene/scene.hpp"
#include "solver/phasefield/grid.hpp"

namespace fracfarm::phasefield {

// Elements (column, row) that hold a part of the segment of positive length. Elements own their left and lower edges, so a segment on
// a grid line belongs to the elements right of it or above it; parts outside the grid are dropped. Segment in metres.
std::vector<std::pair<int, int>> crossed_elements(const Segment& segment, const Grid& grid);

// One byte a node, columns * rows, row 0 at the bottom: 1 where psi is held at 1.
std::vector<unsigned char> slot_mask(std::span<const Segment> cracks, const Grid& grid);

}  // namespace fracfarm::phasefield
