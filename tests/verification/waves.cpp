// PF-5 to PF-8: undamaged waves in time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/random.hpp"
#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"

namespace fracfarm::verification {
namespace {

constexpr int wave_cells = 24;

// Standing waves along x are the periodic plane waves of twice the length: P between rollers, S between sides that only slide.
Scene wave_scene(const Material& material, bool shear) {
  Scene scene = plain_scene(material, wave_cells, 3, dataset_h);
  SideLoad slide;
  slide.to = scene.width;
  slide.tangential = Tangential::fixed;
  for (const Side side : {Side::bottom, Side::top}) set_load(scene, side, shear ? slide : roller(scene.width));
  if (!shear)
    for (const Side side : {Side::left, Side::right}) set_load(scene, side, roller(scene.height));
  return scene;
}

// Worst error of the amplitude over 200 steps against cos(n omega dt).
Row standing_wave(std::string_view name, bool shear, int half_waves, double nu_share) {
  const Material material = tough(name);
  Bench bench(wave_scene(material, shear));
  const double c = std::sqrt((shear ? material.elasticity.C55 : material.elasticity.C11) / material.density);
  const double dt = nu_share * bench.model.stable_dt, k = half_waves * std::numbers::pi / (wave_cells * dataset_h), tiny = 1e-9;
  bench.set_displacement([&](double x, double) {
    return shear ? std::pair{0.0, tiny * std::cos(k * x)} : std::pair{tiny * std::sin(k * x), 0.0};
  });
  const phasefield::Field<double> start = shear ? bench.state.uz : bench.state.ux;
  bench.release(dt);
  const double nu = c * dt / dataset_h, omega_dt = 2.0 * std::asin(nu * std::sin(0.5 * k * dataset_h));
  double worst = 0.0;
  for (int n = 1; n <= 200; ++n) {
    if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n - 1, dt))
      return compare("step", "1", 0.0, INFINITY, 1e-8);
    const phasefield::Field<double>& now = shear ? bench.state.uz : bench.state.ux;
    double dot = 0.0, square = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) dot += now[i] * start[i], square += start[i] * start[i];
    worst = std::max(worst, std::abs(dot / square - std::cos(n * omega_dt)));
  }
  return compare(fmt::format("{} {} wave, {} half waves on {} cells, nu = {:.3f}: worst amplitude error of 200 steps", name,
                             shear ? "S" : "P", half_waves, wave_cells, nu),
                 "1", 0.0, worst, 1e-8);
}

double largest_displacement(const Bench& bench) {
  double largest = 0.0;
  for (const phasefield::Field<double>* field : {&bench.state.ux, &bench.state.uz})
    for (const double u : *field) largest = std::max(largest, std::isfinite(u) ? std::abs(u) : INFINITY);
  return largest;
}

// Plate with random displacements, let go: largest displacement after 1500 steps over that of the start. Sides free, but for the normal
// displacement of top and bottom where they are held as in the uniaxial load.
double growth(std::string_view name, double share, bool held) {
  Scene scene = plain_scene(tough(name), 60, 60, dataset_h);
  if (held)
    for (const Side side : {Side::bottom, Side::top}) set_load(scene, side, roller(scene.width));
  Bench bench(scene);
  RandomStream random(2026, 1, 6);
  bench.set_displacement([&](double, double) { return std::pair{random.uniform(-1e-9, 1e-9), random.uniform(-1e-9, 1e-9)}; });
  const double dt = share * bench.model.stable_dt, start = largest_displacement(bench);
  bench.release(dt);
  for (int n = 0; n < 1500; ++n) bench.glide(dt);
  return largest_displacement(bench) / start;
}

// Leapfrog keeps K(v_n) + U(u_n) - dt^2/8 sum f^2/m to rounding, where the force is linear.
double invariant(Bench& bench, double dt) {
  double correction = 0.0;
  for (std::size_t n = 0; n < bench.scratch.fx.size(); ++n)
    correction += bench.scratch.fx[n] * bench.scratch.fx[n] * bench.model.inverse_mass_x[n] +
                  bench.scratch.fz[n] * bench.scratch.fz[n] * bench.model.inverse_mass_z[n];
  return bench.state.sums.kinetic + bench.state.sums.elastic - 0.125 * dt * dt * correction;
}

}  // namespace

std::vector<Row> dispersion() {
  std::vector<Row> rows;
  for (const bool shear : {false, true})
    for (const int half_waves : {1, 6, 17, 23})
      for (const double share : {0.5, 0.9}) rows.push_back(standing_wave(half_waves % 2 ? "shale" : "pbx", shear, half_waves, share));
  rows.back().note = "explicit scheme; Newmark's row comes with that integrator";
  return rows;
}

std::vector<Row> stability_edge() {
  std::vector<Row> rows;
  constexpr std::array<double, 5> edges_ns{586.8, 461.6, 334.3, 317.4, 296.4};
  for (std::size_t k = 0; k < dataset_materials.size(); ++k) {
    const std::string_view name = dataset_materials[k];
    const double edge = Bench(plain_scene(tough(name), 4, 4, dataset_h)).model.stable_dt;
    Row row = compare(fmt::format("{} edge", name), "ns", edges_ns[k], 1e9 * edge, 2e-4);
    const double below = growth(name, 0.999, true), above = growth(name, 1.001, true);
    row.note = fmt::format("top and bottom held: 1500 steps at 0.999 grew {:.2f} times, at 1.001 {:.0e} times", below, above);
    row.passed = row.passed && below < 10.0 && above > 1e6;
    rows.push_back(row);
  }
  // With all four sides free the formula is not sharp for PBX: a free corner of a material with C13 > C55 vibrates faster than any wave
  // inside. These two rows pin where that edge lies; the rows above hold top and bottom as the dataset's loads do.
  const std::string note = "all sides free, the formula's edge is missed: PBX is stable only up to 0.985 of it";
  rows.push_back(compare("pbx, all sides free: log10 of the growth at 0.980 of the edge", "1", 0.0, std::log10(growth("pbx", 0.98, false)),
                         1.0, note));
  rows.push_back(compare("pbx, all sides free: 1 if unstable at 0.990", "1", 1.0, growth("pbx", 0.99, false) > 1e6 ? 1.0 : 0.0, 0.0, note));
  return rows;
}

std::vector<Row> energy_conservation() {
  Bench bench(plain_scene(tough("shale"), 8, 8, dataset_h));
  const double dt = 0.9 * bench.model.stable_dt;
  RandomStream random(2026, 1, 7);
  bench.set_displacement([&](double x, double z) {
    return std::pair{1e-8 * x * z + random.uniform(-1e-11, 1e-11), 1e-6 * z - 1e-8 * x * x};
  });
  bench.release(dt);
  const double first = invariant(bench, dt);
  double drift = 0.0, low = INFINITY, high = 0.0;
  for (int n = 0; n < 100000; ++n) {
    if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n, dt)) return {compare("step", "1", 0.0, INFINITY, 0.0)};
    drift = std::max(drift, std::abs(invariant(bench, dt) / first - 1.0));
    const double energy = bench.state.sums.kinetic + bench.state.sums.elastic;
    low = std::min(low, energy), high = std::max(high, energy);
  }
  return {compare("drift of the scheme's invariant, 1e5 steps at 0.9 of the edge", "1", 0.0, drift, 1e-10,
                  "explicit; Newmark's row comes with that integrator"),
          compare("kinetic + elastic energy: largest over smallest - 1 (bounded)", "1", 0.0, high / low - 1.0, 0.5)};
}

std::vector<Row> impedance() {
  std::vector<Row> rows;
  constexpr int cells = 400;
  constexpr std::array<double, 5> targets_mpa{5.53, 6.83, 99.2, 14.5, 46.0};
  for (std::size_t k = 0; k < dataset_materials.size(); ++k) {
    const Material material = tough(dataset_materials[k]);
    Scene scene = plain_scene(material, 2, cells, dataset_h);
    for (const Side side : {Side::left, Side::right}) set_load(scene, side, roller(scene.height));
    SideLoad pull = roller(scene.width);
    pull.normal_velocity = 1.0;
    set_load(scene, Side::top, pull);
    Bench bench(scene);
    const double c = std::sqrt(material.elasticity.C33 / material.density), dt = 0.9 * bench.model.stable_dt;
    if (!phasefield::start(bench.model, scene.initial, bench.state, bench.scratch, bench.kernels, dt))
      return {compare("start", "Pa", 1.0, 0.0, 0.0)};
    const int steps = static_cast<int>(0.9 * scene.height / (c * dt));
    double sum = 0.0;
    int counted = 0;
    for (int n = 0; n < steps; ++n) {
      if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n, dt)) return {compare("step", "Pa", 1.0, 0.0, 0.0)};
      if (n < steps / 10) continue;
      double force = 0.0;
      for (int i = 0; i < bench.model.grid.columns; ++i) force -= bench.scratch.fz[bench.at(i, cells)];
      sum += force / scene.width, ++counted;
    }
    const double exact = std::sqrt(material.elasticity.C33 * material.density);
    rows.push_back(compare(fmt::format("{} stress behind the front, 1 m/s", dataset_materials[k]), "Pa", exact, sum / counted, 0.01,
                           fmt::format("published rounded to {} MPa", targets_mpa[k])));
  }
  return rows;
}

}  // namespace fracfarm::verification
