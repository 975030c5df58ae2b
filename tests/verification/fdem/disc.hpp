// A disc of triangles: points on rings, each turned and shaken by chance, Delaunay.
#pragma once

#include <cstdint>

#include "common/scene/triangle_mesh.hpp"

namespace fracfarm::verification {

// Centre at (radius, radius); the rim is a polygon with sides of about `element_size` whose corners lie on the circle.
TriangleMesh disc_mesh(double radius, double element_size, std::uint64_t seed);

}  // namespace fracfarm::verification
