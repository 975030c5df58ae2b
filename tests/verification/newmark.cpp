// PF-5 and PF-7 of the Newmark scheme with beta = 1/4, gamma = 1/2: undamaged waves, and an energy that stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/random.hpp"
#include "solver/phasefield/assembled/assembled.hpp"
#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"

namespace fracfarm::verification {
namespace {

using phasefield::assembled::Assembled;
using phasefield::assembled::Vector;

constexpr int wave_cells = 24;

Scene newmark(Scene scene) {
  scene.phase_field.integrator = Integrator::newmark;
  return scene;
}

// At rest with these displacements, in balance with the first acceleration. The run was started.
template <class Displacement>  // (x, z) -> {ux, uz}, m
void release(Assembled& run, double dt, Displacement displacement) {
  phasefield::assembled::State& state = run.state();
  const phasefield::assembled::Model& model = run.model();
  for (int j = 0; j < model.grid.rows; ++j)
    for (int i = 0; i < model.grid.columns; ++i) {
      const auto [x, z] = displacement(i * model.grid.hx, j * model.grid.hz);
      state.u[2 * model.node(i, j)] = x, state.u[2 * model.node(i, j) + 1] = z;
    }
  phasefield::assembled::refresh(model, state, run.scratch(), 0, dt);
  for (Eigen::Index d = 0; d < state.a.size(); ++d)
    state.a[d] = model.equation[static_cast<std::size_t>(d)] >= 0 ? run.scratch().force[d] / model.mass[d] : 0.0;
}

// Standing waves along x between rollers (P) or sides that only slide (S); worst error of the amplitude over 200 steps.
Row standing_wave(std::string_view name, bool shear, int half_waves, double steps_of_edge) {
  const Material material = tough(name);
  Scene scene = newmark(plain_scene(material, wave_cells, 3, dataset_h));
  SideLoad slide;
  slide.to = scene.width;
  slide.tangential = Tangential::fixed;
  for (const Side side : {Side::bottom, Side::top}) set_load(scene, side, shear ? slide : roller(scene.width));
  if (!shear)
    for (const Side side : {Side::left, Side::right}) set_load(scene, side, roller(scene.height));
  Assembled run(scene);
  const double c = std::sqrt((shear ? material.elasticity.C55 : material.elasticity.C11) / material.density);
  const double dt = steps_of_edge * run.stable_dt(), k = half_waves * std::numbers::pi / (wave_cells * dataset_h), tiny = 1e-9;
  if (!run.start(dt)) return compare("start", "1", 0.0, INFINITY, 1e-8);
  release(run, dt, [&](double x, double) {
    return shear ? std::pair{0.0, tiny * std::cos(k * x)} : std::pair{tiny * std::sin(k * x), 0.0};
  });
  const Vector start = run.state().u;
  const double nu = c * dt / dataset_h, omega_dt = 2.0 * std::atan(nu * std::sin(0.5 * k * dataset_h));
  double worst = 0.0;
  for (int n = 1; n <= 200; ++n) {
    if (!run.step(n - 1, dt)) return compare("step", "1", 0.0, INFINITY, 1e-8);
    worst = std::max(worst, std::abs(run.state().u.dot(start) / start.squaredNorm() - std::cos(n * omega_dt)));
  }
  return compare(fmt::format("{} {} wave, {} half waves on {} cells, nu = {:.3g}: worst amplitude error of 200 steps", name,
                             shear ? "S" : "P", half_waves, wave_cells, nu),
                 "1", 0.0, worst, 1e-8);
}

}  // namespace

std::vector<Row> newmark_dispersion() {
  std::vector<Row> rows;
  for (const bool shear : {false, true})
    for (const int half_waves : {1, 6, 23})
      for (const double steps : {0.9, 8.0}) rows.push_back(standing_wave(half_waves % 2 ? "shale" : "pbx", shear, half_waves, steps));
  return rows;
}

std::vector<Row> newmark_energy() {
  Assembled run(newmark(plain_scene(tough("shale"), 8, 8, dataset_h)));
  const double dt = 5.0 * run.stable_dt();
  if (!run.start(dt)) return {compare("start", "1", 0.0, INFINITY, 0.0)};
  RandomStream random(2026, 1, 7);
  release(run, dt, [&](double x, double z) { return std::pair{1e-8 * x * z + random.uniform(-1e-11, 1e-11), 1e-6 * z - 1e-8 * x * x}; });
  const auto energy = [&](int n) {
    const SampleRow row = run.sample(n, dt);
    return row.kinetic_energy + row.elastic_energy;
  };
  const double first = energy(0);
  double drift = 0.0;
  constexpr int steps = 100000;
  for (int n = 0; n < steps; ++n) {
    if (!run.step(n, dt)) return {compare("step", "1", 0.0, INFINITY, 0.0)};
    if (n % 10 == 9) drift = std::max(drift, std::abs(energy(n + 1) / first - 1.0));
  }
  return {compare(fmt::format("drift of kinetic + elastic energy, {} steps at 5 times the explicit edge", steps), "1", 0.0, drift, 1e-10)};
}

}  // namespace fracfarm::verification
