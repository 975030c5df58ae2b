// Cracks on the grid, by the three ways of seeding them. Slot: the four nodes of every element that a segment crosses are held at psi = 1.
// Nodes: one row of nodes is. History: the elements that a segment crosses begin with a large H, and nothing is held.
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

// The same for one row of nodes: those nearest to the segment on the grid lines that it crosses at the steeper angle.
std::vector<unsigned char> node_mask(std::span<const Segment> cracks, const Grid& grid);

// By the scene's seeding; all 0 where the history is seeded.
std::vector<unsigned char> held_mask(CrackSeeding seeding, std::span<const Segment> cracks, const Grid& grid);

// H of a seeded element, J/m^3: psi = 0.999 in a uniform field (Borden, Verhoosel, Scott, Hughes and Landis, 2012, with B = 1000).
inline double seeded_history(double Gc, double width) { return 500.0 * Gc / width; }
// One byte an element, row 0 at the bottom: 1 where the history is seeded.
std::vector<unsigned char> seeded_elements(CrackSeeding seeding, std::span<const Segment> cracks, const Grid& grid);

}  // namespace fracfarm::phasefield
