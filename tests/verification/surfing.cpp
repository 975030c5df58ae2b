// PF-25: a crack drawn through a strip at a steady speed by the moving field around a tip; the energy that it takes per advance.
#include <fmt/format.h>

#include <cmath>

#include "tests/verification/cases.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/held_nodes.hpp"
#include "tests/verification/pictures.hpp"
#include "tests/verification/specimen.hpp"

namespace fracfarm::verification {
namespace {

constexpr double h = 0.5e-3, width = 2.0 * h, young = 32e9, poisson = 0.2, density = 2450.0, Gc = 3.0;
constexpr double share = h / width;  // s of the closed forms

struct Track {
  std::vector<double> tip, released, surface;  // m, J/m, J/m
};

// H where the material is not broken yet, so that only a crack stays: what the irreversibility of H adds is then left out.
void forget(Bench& bench) {
  const phasefield::Grid& grid = bench.model.grid;
  for (int j = 0; j < grid.cells_z(); ++j)
    for (int i = 0; i < grid.cells_x(); ++i)
      for (int corner = 0; corner < 4; ++corner)
        if (bench.state.psi[bench.at(i + corner % 2, j + corner / 2)] < 0.95) bench.set_history(i, j, corner, 0.0);
}

// The crack begins 40 cells inside; its field moves on by 120 cells at `speed` times c_s. An odd number of cells up puts its line into a
// row of elements.
Track surf(Desk& desk, bool forgets, double speed, double begin, double part) {
  constexpr int cells_x = 240, cells_z = 81;
  Scene scene = plain_scene(material_of({density, young, poisson, Gc}), cells_x, cells_z, h);
  scene.phase_field.residual_stiffness = 1e-6;
  scene.phase_field.length_scale = {LengthScale::Kind::metres, width};
  const double middle = 0.5 * scene.height, c_s = std::sqrt(0.5 * young / (1.0 + poisson) / density), first = 40.0 * h;
  scene.cracks = {{0.0, middle, first, middle}};
  Bench bench(scene);
  HeldNodes frame(
      bench, [&](double x, double z) { return x < 0.5 * h || x > scene.width - 0.5 * h || z < 0.5 * h || z > scene.height - 0.5 * h; });
  const double dt = 0.9 * bench.model.stable_dt, V = speed * c_s, opening = 400.0 * h / c_s, end = opening + 120.0 * h / V;
  if (!phasefield::start(bench.model, scene.initial, bench.state, bench.scratch, bench.kernels, dt)) return {};
  const NearTip near{young, poisson};
  const double toughness = std::sqrt(near.modulus() * Gc);
  Track track;
  for (int n = 0; n * dt < end; ++n) {
    const double t = (n + 1) * dt, K = toughness * std::min(1.0, t / opening), ahead = first + std::max(0.0, t - opening) * V;
    frame.shape([&](double x, double z) { return near.at(x - ahead, z - middle); });
    frame.aim(K, dt);
    if (forgets) forget(bench);
    if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n, dt)) return {};
    if (n % 50) continue;
    desk.progress("surfing", begin + part * n * dt / end);
    double tip = 0.0;
    for (int i = 1; i <= cells_x; ++i)
      for (int j = 0; j <= cells_z; ++j) {
        const double behind = bench.state.psi[bench.at(i - 1, j)], here = bench.state.psi[bench.at(i, j)];
        if (behind > 0.9 && here <= 0.9) tip = std::max(tip, (i - 1 + (behind - 0.9) / (behind - here)) * h);
      }
    const phasefield::SurfaceSum sum = bench.surface();
    track.tip.push_back(tip), track.released.push_back(bench.state.released), track.surface.push_back(sum.local + sum.gradient);
  }
  return track;
}

// Slope of y over the tip's place while the tip is between two places, by least squares.
double per_advance(const Track& track, const std::vector<double>& y, double from, double to) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double x = track.tip[k];
    if (x < from || x > to) continue;
    n += 1.0, sx += x, sy += y[k], sxx += x * x, sxy += x * y[k];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

std::vector<Row> surfing(Desk& desk) {
  const double root = std::sqrt(1.0 + 0.25 * share * share);
  std::vector<Row> rows;
  Chart chart{"Energy released to the crack", {"tip", "m"}, {"energy", "J/m"}, {}};
  struct Kind {
    double speed;
    bool forgets;
    const char* name;
  };
  int k = 0;
  for (const auto& [speed, forgets, name] :
       {Kind{0.02, false, "H kept"}, Kind{0.05, false, "H kept"}, Kind{0.05, true, "H kept in the crack alone"}}) {
    const Track track = surf(desk, forgets, speed, k / 3.0, 1.0 / 3.0);
    const double from = 70.0 * h, to = 140.0 * h, G = per_advance(track, track.released, from, to) / Gc;
    std::string note = fmt::format("the surface functional grows by {:.3f} Gc", per_advance(track, track.surface, from, to) / Gc);
    if (!forgets && G > 0.5 * share + root)
      note += "; over by what H keeps of the passing tip beside the crack: the last row leaves that out";
    rows.push_back(between(fmt::format("energy released per advance over Gc, {} c_s, {}", speed, name), "1", {root, 0.5 * share + root}, G,
                           0.0, note));
    chart.lines.push_back({fmt::format("{} c_s, {}", speed, name), palette[k++], track.tip, track.released});
  }
  desk.add({"surfing", "PF-25: energy given up to damage as the tip moves; its slope is the toughness that the grid shows.",
            chart_page({chart})});
  return rows;
}

}  // namespace fracfarm::verification
