// Cracks that a mesh of the element size can follow: parallel overlapping cracks closer than half an element become one, ends closer than
// half an element to a crack, a side or a layer end on it. Crossings and what is left are the crack graph's.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "solver/fdem/mesh/make_mesh.hpp"

namespace fracfarm::fdem {

struct RepairedCracks {
  std::vector<Segment> cracks;
  int moved = 0, trimmed = 0, extended = 0;
};

// A sentence where the choice cannot be meshed at all: values that are not finite, a body or a layer of less than an element, a crack
// shorter than half an element, more elements than the body may have, more cracks than fit.
std::string refusal(const MeshChoice& choice);

// The part of it that holds for meshes from files, too: finite numbers, and no more cracks than can be looked at.
std::string refusal_of_numbers(const MeshChoice& choice);

// The choice must have passed refusal().
RepairedCracks repair(const MeshChoice& choice);

}  // namespace fracfarm::fdem
