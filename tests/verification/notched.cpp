// PF-20 and PF-21: the notched square pulled and sheared, quasi-statically, its notch a cut of one element's height with free faces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/phasefield/assembled/assembled.hpp"
#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"
#include "tests/verification/specimen.hpp"

namespace fracfarm::verification {
namespace {

constexpr double side = 1e-3, micrometre = 1e-6;  // m

// An odd number of cells up, so that the cut lies in the middle.
Scene square(int cells, double l, Split split) {
  Scene scene = plain_scene(material_of({7800.0, 210e9, 0.3, 2700.0}), cells, cells + 1 - cells % 2, 1.0);
  scene.width = scene.height = scene.layers[0].below = side;
  PhaseFieldSettings& settings = scene.phase_field;
  settings.residual_stiffness = 1e-9;
  settings.length_scale = {LengthScale::Kind::metres, l};
  settings.split = split;
  settings.quadrature = Quadrature::gauss;
  settings.integrator = Integrator::quasi_static;
  settings.staggered_tolerance = 1e-6;
  settings.staggered_passes = 100;
  settings.dt = 1.0;
  set_load(scene, Side::bottom, roller(side, Tangential::fixed));
  return scene;
}

struct Pull {
  double coarse, fine, from;  // displacement of the head in a step (m): coarse up to `from`, fine after it
  Axis axis;
};

struct Curve {
  std::vector<double> u{0.0}, force{0.0};  // m, N for a thickness of 1 mm
  double peak = 0.0, at = 0.0;
  std::vector<Damage> panels;
  double stiffness() const { return u.size() > 1 ? force[1] / u[1] : NAN; }  // N/m
};

// Moves the head, one metre a second on the load's clock, until the force has fallen by a tenth from its peak.
Curve pull(Desk& desk, const Scene& scene, const Pull& pull, bool cut) {
  phasefield::assembled::Assembled body(scene);
  const int across = body.columns() - 1, up = body.rows() - 1;
  if (cut) {
    body.model().cut_out.assign(static_cast<std::size_t>(across * up), 0);
    for (int i = 0; 2 * i < across; ++i) body.model().cut_out[static_cast<std::size_t>(up / 2 * across + i)] = 1;
  }
  Curve curve;
  if (!body.start(1.0)) return curve;
  for (int n = 0; curve.force.back() >= 0.9 * curve.peak && curve.u.back() < 15.0 * micrometre; ++n) {
    const double step = curve.u.back() < pull.from ? pull.coarse : pull.fine;
    if (!body.step(n, step)) return curve;
    double force = 0.0;
    for (int i = 0; i <= across; ++i) force += body.reaction(i, up, pull.axis) * 1e-3;
    curve.u.push_back(curve.u.back() + step), curve.force.push_back(force);
    if (force > curve.peak) curve.peak = force, curve.at = curve.u.back();
    desk.progress("notched square", 0.9 * curve.u.back() / (1.1 * pull.from));
  }
  std::vector<double> psi;
  body.copy_damage(psi);
  curve.panels.push_back({fmt::format("{:.2f} µm", curve.u.back() / micrometre), {psi.begin(), psi.end()}, across + 1, up + 1, side, side});
  return curve;
}

// The same specimen on three grids (even numbers of cells, so that the notch ends in the middle), each twice as fine as the one before; the
// cut and its corners make it first order in h.
struct Refined {
  std::array<Curve, 3> curves;
  // A figure of the curve on the finest grid, or what it tends to; the note has the figures of the three grids and the limit of the last
  // two.
  Row row(std::string what, std::string unit, Bounds target, double tolerance, double (*of)(const Curve&), bool in_the_limit) const {
    const double coarse = of(curves[0]), middle = of(curves[1]), fine = of(curves[2]), limit = 2.0 * fine - middle;
    return between(std::move(what), std::move(unit), target, in_the_limit ? limit : fine, tolerance,
                   fmt::format("on the three grids {:.4g}, {:.4g}, {:.4g}; limit of the last two {:.4g}", coarse, middle, fine, limit));
  }
};

template <class SceneOf>
Refined refine(Desk& desk, std::array<int, 3> cells, const Pull& way, SceneOf scene_of, Chart& chart) {
  Refined refined;
  constexpr std::array<double, 4> begin{0.0, 0.02, 0.12, 1.0};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    desk.part(begin[k], begin[k + 1] - begin[k]);
    refined.curves[k] = pull(desk, scene_of(cells[k]), way, true);
    chart.lines.push_back({fmt::format("{}²", cells[k]), palette[k], refined.curves[k].u, refined.curves[k].force});
  }
  return refined;
}

double peak(const Curve& curve) { return curve.peak; }
double at_peak(const Curve& curve) { return curve.at; }
double stiffness(const Curve& curve) { return curve.stiffness(); }

}  // namespace

std::vector<Row> notched_tension(Desk& desk) {
  const auto scene_of = [](int cells) {
    Scene scene = square(cells, 0.015e-3, Split::none);
    SideLoad head = roller(side);
    head.normal_velocity = 1.0;
    set_load(scene, Side::top, head);
    return scene;
  };
  Chart chart{"Notched square, tension", {"displacement", "m"}, {"force", "N"}, {}};
  const Refined refined = refine(desk, {68, 136, 272}, {0.25 * micrometre, 0.02 * micrometre, 5.0 * micrometre, Axis::z}, scene_of, chart);
  desk.add({"notched_tension", "PF-20: force on the head against its displacement, for a thickness of 1 mm, on three grids.",
            chart_page({chart})});
  return {refined.row("stiffness, h = l/4", "N/m", {137.9e6, 138.2e6}, 0.005, stiffness, false),
          refined.row("peak force, 1 mm thick, h = l/4", "N", {690.0, 701.0}, 0.03, peak, false),
          refined.row("displacement at the peak, h = l/4", "m", {5.55e-6, 5.59e-6}, 0.02, at_peak, false)};
}

std::vector<Row> notched_shear(Desk& desk) {
  const auto scene_of = [](int cells) {
    Scene scene = square(cells, 0.06e-3, Split::spectral);
    SideLoad head = roller(side), flank;
    head.tangential = Tangential::velocity, head.tangential_velocity = 1.0;
    set_load(scene, Side::top, head);
    flank.to = side, flank.tangential = Tangential::fixed;
    for (const Side where : {Side::left, Side::right}) set_load(scene, where, flank);
    return scene;
  };
  Chart chart{"Notched square, shear", {"displacement", "m"}, {"force", "N"}, {}};
  const Refined refined = refine(desk, {30, 60, 120}, {0.4 * micrometre, 0.025 * micrometre, 8.6 * micrometre, Axis::x}, scene_of, chart);
  desk.add({"notched_shear", "PF-21: force on the head against its displacement, for a thickness of 1 mm, on three grids.",
            chart_page({chart})});
  desk.add({"notched_shear_damage", "PF-21: damage when the force has fallen by a tenth, finest grid.",
            damage_page("Notched square, shear", refined.curves[2].panels, 420)});
  return {refined.row("peak force, 1 mm thick, h to 0", "N", {494.7, 494.7}, 0.03, peak, true),
          refined.row("displacement at the peak, h to 0", "m", {8.70e-6, 8.70e-6}, 0.03, at_peak, true),
          refined.row("stiffness, h to 0", "N/m", {63.44e6, 63.44e6}, 0.01, stiffness, true)};
}

}  // namespace fracfarm::verification
