// Scenes that the solver's tests share: Table 1 materials on small grids, built by hand.
#pragma once

#include "common/material/material.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm::test {

inline SideLoad pull(double velocity, double length) {
  SideLoad load;
  load.to = length;
  load.normal_velocity = velocity;
  return load;
}

inline void set_load(Scene& scene, Side side, const SideLoad& load) { scene.loads[static_cast<std::size_t>(side)] = {load}; }

// A square of `cells` x `cells` elements of h = 250/127 mm, no cracks, no loads, a horizon of 100 us, frames every 20 us.
inline Scene square(std::string_view material, int cells) {
  Scene scene;
  scene.width = scene.height = 0.25 * cells / 127.0;
  scene.layers = {{scene.height, *find_material(material)}};
  scene.horizon = 1e-4;
  scene.frame_interval = 2e-5;
  scene.phase_field.cells_x = scene.phase_field.cells_z = cells;
  if (!scene.layers[0].material.plasticity) scene.phase_field.plasticity = PlasticityModel::none;
  return scene;
}

inline Scene pulled(std::string_view material, int cells, double velocity = 1.0) {
  Scene scene = square(material, cells);
  set_load(scene, Side::top, pull(velocity, scene.width));
  set_load(scene, Side::bottom, pull(velocity, scene.width));
  return scene;
}

// Pulled briskly, with a crack from the left side to a third of the width: breaks within the horizon.
inline Scene cracked(std::string_view material, int cells) {
  Scene scene = pulled(material, cells, 3.0);
  scene.cracks = {{0.0, 0.503 * scene.height, 0.35 * scene.width, 0.503 * scene.height}};
  return scene;
}

}  // namespace fracfarm::test
