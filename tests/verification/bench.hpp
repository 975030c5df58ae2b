// A phase-field model opened for verification: its parts by name, so that a case can set fields that no scene can say.
#pragma once

#include "common/material/material.hpp"
#include "solver/phasefield/passes.hpp"
#include "solver/phasefield/step.hpp"

namespace fracfarm::verification {

inline constexpr double no_damage = 1e15;  // G_c at which psi stays below rounding

struct Bench {
  phasefield::Model model;
  phasefield::State<double> state;
  phasefield::Scratch<double> scratch;
  const phasefield::Kernels<double>& kernels;

  explicit Bench(const Scene& scene)
      : model(phasefield::build_model(scene)), state(phasefield::make_state<double>(model)), kernels(phasefield::chosen_kernels<double>()) {
    model.keeps_forces = true;
    remake();
  }

  // After a change of the model.
  void remake() { scratch = phasefield::make_scratch<double>(model); }

  phasefield::View<double> view() { return phasefield::view(model, state, scratch); }
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
  // H at a corner (sw se nw ne) of an element, J/m^3.
  void set_history(int column, int row, int corner, double value) {
    phasefield::set_history(model.grid, state, column, row, corner, value);
  }
  double history(int column, int row, int corner) const { return phasefield::history_at(model.grid, state, column, row, corner); }
  phasefield::SurfaceSum surface() { return phasefield::surface(model, state, scratch, kernels); }
  // History, damage, degradation and force of the displacements as they are.
  phasefield::StressSum respond() {
    phasefield::strain(model, state, scratch, kernels);
    if (!phasefield::solve_damage(model, state, scratch, kernels)) return {NAN, NAN};
    state.sums = phasefield::respond(model, state, scratch, kernels, 0.0);
    return state.sums.stress;
  }
  // Displacements and velocities as they are become those of t = 0: velocities go half a step ahead.
  void release(double dt) {
    phasefield::strain(model, state, scratch, kernels);
    state.sums = phasefield::respond(model, state, scratch, kernels, 0.0);
    phasefield::respond(model, state, scratch, kernels, 0.5 * dt);
  }
  // A step without history and damage.
  void glide(double dt) {
    const phasefield::View<double> v = view();
    for (int j = 0; j < v.rows; ++j) kernels.drift(v, j, dt);
    state.sums = phasefield::respond(model, state, scratch, kernels, dt);
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
