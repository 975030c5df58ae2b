// What both paths of the method (row kernels and assembled matrices) read out of a scene in the same way: grid, materials by height, length
// scale, surface law, the edge of central differences, nodes along the sides.
#pragma once

#include "common/scene/scene.hpp"
#include "solver/boundary.hpp"
#include "solver/law/elastic.hpp"
#include "solver/law/surface.hpp"
#include "solver/phasefield/grid.hpp"

namespace fracfarm::phasefield {

Grid make_grid(const Scene& scene);

// Of the layer at height z (m).
const Material& material_at(const Scene& scene, double z);

// Pa, in plane strain or plane stress.
law::Stiffness<double> stiffness_of(const Material& material, const PhaseFieldSettings& settings);

// w_0, m.
double length_scale(const Material& material, const PhaseFieldSettings& settings);
law::SurfaceLaw<double> surface_law(const Material& material, const PhaseFieldSettings& settings);

// Of the star-convex split the settings ask for; 0 for the volumetric-deviatoric one and for splits that keep nothing more.
double star_convexity(const PhaseFieldSettings& settings);

// Edge of the central differences, s: h / sqrt((C_max + C55) / rho) on squares; on rectangles the smaller of (C11/hx^2 + C55/hz^2) and
// (C33/hz^2 + C55/hx^2) at sqrt(rho / .). Broken material under pressure is as stiff as the star-convex split makes it, (1 + gamma*) K,
// which may be more than what it was.
double stable_dt(const law::Stiffness<double>& C, double density, const PhaseFieldSettings& settings, const Grid& grid);

// `index(column, row)` is a node's place in the solver's fields.
template <class Index>
SideNodes side_nodes(const Grid& grid, Index index) {
  SideNodes nodes;
  const auto add = [&](Side side, int count, double h, auto at) {
    for (int k = 0; k < count; ++k)
      nodes[static_cast<std::size_t>(side)].push_back(
          {static_cast<std::size_t>(at(k)), k * h, k > 0 ? (k - 0.5) * h : 0.0, k + 1 < count ? (k + 0.5) * h : (count - 1) * h});
  };
  add(Side::left, grid.rows, grid.hz, [&](int k) { return index(0, k); });
  add(Side::right, grid.rows, grid.hz, [&](int k) { return index(grid.columns - 1, k); });
  add(Side::bottom, grid.columns, grid.hx, [&](int k) { return index(k, 0); });
  add(Side::top, grid.columns, grid.hx, [&](int k) { return index(k, grid.rows - 1); });
  return nodes;
}

}  // namespace fracfarm::phasefield
