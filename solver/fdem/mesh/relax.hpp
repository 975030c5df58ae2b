// What makes a triangulation of random points a mesh: gaps filled, free points moved towards even triangles, the flattest triangles mended.
// Few sweeps, on purpose: many would grow patches of lattice, along whose lines cracks run.
#pragma once

#include "solver/fdem/mesh/free_points.hpp"
#include "solver/fdem/mesh/triangulation.hpp"

namespace fracfarm::fdem {

// Points from `first_free` on may move; what is before belongs to the lines.
struct Relaxation {
  Triangulation& triangles;
  int first_free;
  double element_size;  // in lattice units
};

// New points at the centres of circles that hold none and are wider than the spacing. False where flips did not end.
void fill_gaps(Triangulation& triangles, const Lattice& lattice, const CrackGraph& lines, const Spacing& spacing);
bool smooth(const Relaxation& relaxation, int sweeps);
bool mend_flat(const Relaxation& relaxation);

}  // namespace fracfarm::fdem
