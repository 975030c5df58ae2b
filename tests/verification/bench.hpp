// A phase-field model opened for verification: its parts by name, so that a case can set fields that no scene can say.
#pragma once

#include "common/material/material.hpp"
#include "solver/phasefield/damage_solve.hpp"
#include "solver/phasefield/step.hpp"

namespace fracfarm::verification {

inline constexpr double no_damage = 1e15;  // G_c at which psi stays below rounding

struct Bench {
  phasefield::Model model;
  phasefield::State state;
  phasefield::Scratch scratch;
  const phasefield::Kernels& kernels;

  explicit Bench(const Scene& scene)
      : model(phasefield::build_model(scene)),
        state(phasefield::make_state(model)),
        scratch(phasefield::make_scratch(model)),
        kernels(phasefield::chosen_kernels()) {}

  phasefield::View view() { return phasefield::view(model, state, scratch); }
  const double* psi() const { return state.psi.data() + model.grid.origin(); }
  std::size_t at(int column, int row) const { return model.grid.index(column, row); }
  double area() const { return model.grid.hx * model.grid.cells_x() * model.grid.hz * model.grid.cells_z(); }

  template <class Displacement>  // (x, z) -> {ux, uz}, m
  void set_displacement(Displacement u) {
    for (int j = 0; j < model.grid.rows; ++j)
      for (int i = 0; i < model.grid.columns; ++i) {
        const auto [x, z] = u(i * model.grid.hx, j * model.grid.hz);
        state.ux[at(i, j)] = x, state.uz[at(i, j)] = z;
      }
  }
  template <class Velocity>  // (x, z) -> {vx, vz}, m/s
  void set_velocity(Velocity v) {
    for (int j = 0; j < model.grid.rows; ++j)
      for (int i = 0; i < model.grid.columns; ++i) {
        const auto [x, z] = v(i * model.grid.hx, j * model.grid.hz);
        state.vx[at(i, j)] = x, state.vz[at(i, j)] = z;
      }
  }
  // History, damage, degradation and force of the displacements as they are.
  phasefield::StressSum respond() {
    kernels.update_history(view());
    if (!phasefield::solve_damage(model, state, scratch, kernels)) return {NAN, NAN};
    kernels.degrade(view(), psi());
    return scratch.stress = kernels.internal_force(view());
  }
  // At rest with these displacements at t = 0: velocities half a step back.
  void release(double dt) {
    phasefield::refresh(model, state, scratch, kernels, 0, dt);
    for (std::size_t n = 0; n < state.vx.size(); ++n) {
      state.vx[n] -= 0.5 * dt * scratch.fx[n] * model.inverse_mass_x[n];
      state.vz[n] -= 0.5 * dt * scratch.fz[n] * model.inverse_mass_z[n];
    }
  }
};

// cells_x x cells_z squares of `h`, one material.
inline Scene plain_scene(const Material& material, int cells_x, int cells_z, double h) {
  Scene scene;
  scene.width = cells_x * h, scene.height = cells_z * h;
  scene.layers = {{scene.height, material}};
  scene.phase_field.cells_x = cells_x, scene.phase_field.cells_z = cells_z;
  scene.phase_field.plasticity = PlasticityModel::none;
  scene.phase_field.residual_stiffness = 0.0;
  return scene;
}

inline Material tough(std::string_view name) {
  Material material = *find_material(name);
  material.Gc = no_damage;
  return material;
}

// A side that may not move across itself; along itself it is free, or held too.
inline SideLoad roller(double length, Tangential tangential = Tangential::free) {
  SideLoad load;
  load.to = length;
  load.normal_velocity = 0.0;
  load.tangential = tangential;
  return load;
}

inline void set_load(Scene& scene, Side side, const SideLoad& load) { scene.loads[static_cast<std::size_t>(side)] = {load}; }

inline constexpr double dataset_h = 0.25 / 127.0;  // m
inline constexpr std::array<std::string_view, 5> dataset_materials{"pbx", "shale", "tungsten", "aluminum", "steel"};

}  // namespace fracfarm::verification
