// PF-10: what a crack that crosses a strip carries when it is closed, opened and sheared, as a share of the intact strip.
#include <fmt/format.h>

#include <cmath>

#include "tests/verification/cases.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/held_nodes.hpp"
#include "tests/verification/pictures.hpp"
#include "tests/verification/specimen.hpp"
#include "tests/verification/split_list.hpp"

namespace fracfarm::verification {
namespace {

constexpr int up = 40;
constexpr double h = 1e-3, small = 1e-3;  // m; strain

struct Carried {
  double normal, shear;  // Pa, on the top
};

// Equilibrium of the strip between grips that move by these nominal strains. Its sides are kept from widening, but where it is sheared:
// there it is wide, and they are free.
Carried carried(Split split, bool cracked, double normal, double shear) {
  const int across = shear == 0.0 ? 8 : 160;
  Material material = material_of({2000.0, 10e9, 0.3, no_damage});
  Scene scene = plain_scene(material, across, up, h);
  scene.phase_field.residual_stiffness = 1e-6;
  scene.phase_field.length_scale = {LengthScale::Kind::metres, 2.0 * h};
  scene.phase_field.split = split;
  if (cracked) scene.cracks = {{0.0, 0.5 * (up + 1) * h, across * h, 0.5 * (up + 1) * h}};
  Bench bench(scene);
  HeldNodes grips(bench, [](double, double z) { return z < 0.5 * h || z > (up - 0.5) * h; });
  for (int j = 0; j <= up; ++j)
    for (const int i : {0, across})
      if (shear == 0.0) bench.model.inverse_mass_x[bench.at(i, j)] = 0.0;
  bench.remake();
  bench.set_displacement([&](double, double z) { return std::pair{shear * z, normal * z}; });
  bench.respond();
  const double dt = 0.5 * bench.model.stable_dt;
  for (int n = 0; n < 6000; ++n) {  // relaxation: about 20 periods of the slowest mode, damped near its critical value
    bench.glide(dt);
    for (phasefield::Field<double>* v : {&bench.state.vx, &bench.state.vz})
      for (double& value : *v) value *= 0.97;
  }
  Carried sum{};
  for (int i = 0; i <= across; ++i) sum.normal -= bench.scratch.fz[bench.at(i, up)], sum.shear -= bench.scratch.fx[bench.at(i, up)];
  return {sum.normal / (across * h), sum.shear / (across * h)};
}

}  // namespace

std::vector<Row> closure(Desk& desk) {
  const double modulus = carried(Split::seed, false, small, 0.0).normal / small;
  std::vector<Row> rows;
  Chart chart{"Stress across a crack", {"nominal strain (1e-3)", ""}, {"stress", "Pa"}, {}};
  for (std::size_t k = 0; k < all_splits.size(); ++k) {
    const NamedSplit& split = all_splits[k];
    desk.progress(split.name, static_cast<double>(k) / all_splits.size());
    Line line{std::string(split.name), palette[k], {}, {}};
    for (int step = -4; step <= 4; ++step) {
      line.x.push_back(0.25 * step);
      line.y.push_back(carried(split.split, true, 0.25 * step * small, 0.0).normal);
    }
    chart.lines.push_back(line);
    const double closed = line.y.front() / (-small * modulus), open = line.y.back() / (small * modulus);
    const Carried pressed = carried(split.split, true, -small, small), intact = carried(split.split, false, -small, small);
    const double slid = pressed.shear / intact.shear;
    rows.push_back(report(fmt::format("{}: closed crack carries, share of the intact strip", split.name), "1", closed,
                          closed < 0.5    ? "fails: the faces pass through each other"
                          : closed > 1.05 ? "the faces bear, and are stiffer than the intact material"
                                          : "the faces bear on each other"));
    rows.push_back(
        report(fmt::format("{}: open crack carries", split.name), "1", open, open > 0.01 ? "fails: an open crack holds" : "free faces"));
    rows.push_back(report(fmt::format("{}: closed crack carries of a shear", split.name), "1", slid,
                          slid > 0.1 ? "fails: a closed crack holds shear without friction" : "slides freely"));
  }
  chart.lines.push_back({"intact", picture::grey, {-1.0, 1.0}, {-small * modulus, small * modulus}});
  desk.add({"closure",
            "PF-10: mean normal stress of a cracked strip, pressed (left) and pulled (right), sides kept from widening. Seed lies under "
            "none, spectral under the intact line on the left.",
            chart_page({chart})});
  return rows;
}

}  // namespace fracfarm::verification
