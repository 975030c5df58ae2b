// Damage on the edges of a mesh as a picture: the mesh pale, joints that soften by the colour scale, broken ones and initial cracks bold.
// Knows meshes and numbers, no records.
#pragma once

#include <span>

#include "common/picture/canvas.hpp"
#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::picture {

inline constexpr Colour initial_crack_colour{28, 62, 130}, broken_colour{192, 22, 34};

// 0 ... 1 of a joint that is not broken: pale yellow to orange.
Colour softening(double damage);

// One value an edge, 1 broken and 2 initial crack; empty: the mesh alone, its initial cracks drawn. The picture is `width` pixels across
// the mesh's own rectangle, which begins at the origin; a body thinner than a line or taller than three widths is drawn as such. Small
// pictures leave the mesh out.
Canvas draw_mesh(const TriangleMesh& mesh, std::span<const float> damage, int width);

// What the colours stand for, in a column from the upper left corner of the box.
void draw_mesh_key(Canvas& canvas, const Box& box);

}  // namespace fracfarm::picture
