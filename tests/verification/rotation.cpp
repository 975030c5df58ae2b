// PF-9: what a turn of the load does to each split: in the law alone, and to the load at which a crack begins to run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/random.hpp"
#include "solver/law/splits.hpp"
#include "tests/verification/cases.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/held_nodes.hpp"
#include "tests/verification/pictures.hpp"
#include "tests/verification/specimen.hpp"
#include "tests/verification/split_list.hpp"

namespace fracfarm::verification {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double poisson = 0.3, young = 10e9, lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
                 mu = 0.5 * young / (1.0 + poisson);

law::Strain<double> turned(const law::Strain<double>& e, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c * e.xx + s * s * e.zz + c * s * e.xz, s * s * e.xx + c * c * e.zz - c * s * e.xz,
          2.0 * c * s * (e.zz - e.xx) + (c * c - s * s) * e.xz};
}

double drive(Split split, const law::Strain<double>& e) {
  const law::Stiffness<double> C{lambda + 2.0 * mu, lambda, lambda + 2.0 * mu, mu};
  const double third = 1.0 / 3.0, bulk = lambda + 2.0 * mu * third;
  switch (split) {
    case Split::seed:
      return law::SeedSplit<double>{C}.drive(e);
    case Split::none:
      return law::NoSplit<double>{C}.drive(e);
    case Split::spectral:
      return law::SpectralSplit<double>{lambda, mu}.drive(e);
    case Split::volumetric_deviatoric:
      return law::StarConvexSplit<double>{bulk, mu, third, 0.0}.drive(e);
    case Split::star_convex:
      return law::StarConvexSplit<double>{bulk, mu, third, 5.0}.drive(e);
  }
  return NAN;
}

// Largest |drive(turned) - drive| over the undamaged energy, 2000 random strains.
double worst_turn(Split split) {
  RandomStream random(2026, 1, 9);
  double worst = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const law::Strain<double> e{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const double change = drive(split, turned(e, random.uniform(0.0, std::numbers::pi))) - drive(split, e);
    worst = std::max(worst, std::abs(change) / drive(Split::none, e));
  }
  return worst;
}

Chart law_chart(const char* title, const law::Strain<double>& strain) {
  Chart chart{title, {"angle (degrees)", ""}, {"drive / whole energy", ""}, {}};
  for (std::size_t k = 0; k < all_splits.size(); ++k) {
    Line line{std::string(all_splits[k].name), palette[k], {}, {}};
    for (int angle = 0; angle <= 90; ++angle) {
      line.x.push_back(angle);
      line.y.push_back(drive(all_splits[k].split, turned(strain, angle * degree)) / drive(Split::none, strain));
    }
    chart.lines.push_back(line);
  }
  return chart;
}

constexpr double h = 0.5e-3, width = 2.0 * h;  // m
constexpr int cells = 81;
constexpr double centre = 0.5 * cells * h, radius = 38.0 * h;

struct Onset {
  double release_rate;  // G / G_c at which the crack has grown by 2 w_0
  double deviation;     // degrees from its own direction, of the damage between 4 and 8 w_0
};

struct Growth {
  double length;     // m beyond the centre
  double deviation;  // degrees
};

Growth growth_of(const Bench& bench, double c, double s) {
  double farthest = 0.0, along = 0.0, aside = 0.0;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = i * h - centre, z = j * h - centre, r = std::hypot(x, z), psi = bench.state.psi[bench.at(i, j)];
      if (r > radius || c * x + s * z < 0.0 || psi < 0.5) continue;
      if (psi > 0.9) farthest = std::max(farthest, r);
      if (r > 4.0 * width && r < 8.0 * width) along += psi * (c * x + s * z), aside += psi * (c * z - s * x);
    }
  return {farthest, std::atan2(aside, along) / degree};
}

// A disc with a crack from its rim to its centre, both turned by `angle`; the rim moves as around a mode I or a mode II (sliding) tip,
// slowly.
Onset onset(Split split, double angle, bool sliding) {
  const Material material = material_of({2000.0, young, poisson, 100.0});
  Scene scene = plain_scene(material, cells, cells, h);
  scene.phase_field.residual_stiffness = 1e-6;
  scene.phase_field.length_scale = {LengthScale::Kind::metres, width};
  scene.phase_field.split = split;
  const double c = std::cos(angle), s = std::sin(angle);
  scene.cracks = {{centre - 1.1 * radius * c, centre - 1.1 * radius * s, centre, centre}};
  Bench bench(scene);
  HeldNodes rim(bench, [](double x, double z) { return std::hypot(x - centre, z - centre) > radius; });
  const double dt = 0.9 * bench.model.stable_dt;
  if (!phasefield::start(bench.model, scene.initial, bench.state, bench.scratch, bench.kernels, dt)) return {NAN, NAN};
  const NearTip tip{young, poisson};
  rim.shape([&](double x, double z) { return tip.turned(angle, x - centre, z - centre, sliding); });
  const double toughness = std::sqrt(tip.modulus() * material.Gc), end = 1000.0 * h / std::sqrt(mu / material.density);
  Onset found{NAN, NAN};
  for (int n = 0; n * dt < 2.0 * end; ++n) {
    const double K = toughness * std::sqrt(2.0) * (n + 1) * dt / end;  // G = 2 G_c at `end`
    rim.aim(K, dt);
    if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n, dt)) break;
    if (n % 20) continue;
    const Growth growth = growth_of(bench, c, s);
    if (growth.length >= 2.0 * width && std::isnan(found.release_rate)) found.release_rate = K * K / (toughness * toughness);
    if (sliding && !std::isnan(found.release_rate)) break;
    if (growth.length >= 8.0 * width) return {found.release_rate, growth.deviation};
  }
  return found;
}

}  // namespace

std::vector<Row> rotation_of_laws(Desk& desk) {
  std::vector<Row> rows;
  for (const NamedSplit& split : all_splits) {
    const std::string what = fmt::format("{}: largest change of the drive by a turn, over the whole energy", split.name);
    rows.push_back(split.split == Split::seed
                       ? report(what, "1", worst_turn(split.split), "not invariant: it clips the strains along the grid's axes")
                       : compare(what, "1", 0.0, worst_turn(split.split), 1e-12));
  }
  desk.add(
      {"rotation_of_laws", "PF-9: the energy that drives damage as the strain turns against the grid; an invariant law is a level line.",
       chart_page({law_chart("Pure shear", {1.0, -1.0, 0.0}), law_chart("Uniaxial compression", {poisson / (1.0 - poisson), -1.0, 0.0})})});
  return rows;
}

std::vector<Row> rotation(Desk& desk) {
  constexpr int angles = 9;
  std::vector<Row> rows;
  const picture::Axis across{"angle (degrees)", ""};
  Chart opened{"Mode I: G at onset", across, {"G / Gc", ""}, {}}, slid{"Mode II: G at onset", across, {"G / Gc", ""}, {}},
      turn{"Mode I: deviation", across, {"degrees", ""}, {}};
  for (std::size_t k = 0; k < all_splits.size(); ++k) {
    const std::string name(all_splits[k].name);
    Line first{name, palette[k], {}, {}}, second = first, deviations = first;
    double worst = 0.0;
    for (int a = 0; a < angles; ++a) {
      desk.progress(name, (static_cast<double>(k) * angles + a) / (all_splits.size() * angles));
      const double angle = 90.0 * a / (angles - 1);
      const Onset found = onset(all_splits[k].split, angle * degree, false), sheared = onset(all_splits[k].split, angle * degree, true);
      for (Line* line : {&first, &second, &deviations}) line->x.push_back(angle);
      first.y.push_back(found.release_rate), second.y.push_back(sheared.release_rate), deviations.y.push_back(found.deviation);
      worst = std::max(worst, std::isnan(found.deviation) ? INFINITY : std::abs(found.deviation));
    }
    for (const Line* line : {&first, &second}) {
      const bool sliding = line == &second;
      const std::string what = fmt::format("{}: largest over smallest G at onset, mode {}", name, sliding ? "II" : "I");
      const auto held = std::count_if(line->y.begin(), line->y.end(), [](double G) { return std::isnan(G); });
      if (held > 0) {
        rows.push_back(report(what, "1", INFINITY, fmt::format("at {} of {} angles it does not run up to G = 8 Gc", held, angles)));
        continue;
      }
      const auto [low, high] = std::minmax_element(line->y.begin(), line->y.end());
      const std::string strays = sliding ? "" : fmt::format("; grows up to {:.1f} degrees off its direction", worst);
      rows.push_back(report(what, "1", *high / *low, fmt::format("G/Gc {:.2f} – {:.2f}{}", *low, *high, strays)));
    }
    opened.lines.push_back(first), slid.lines.push_back(second), turn.lines.push_back(deviations);
  }
  desk.add({"rotation",
            "PF-9: a crack turned against the grid: energy release rate at which it has grown by 2 w0 in mode I and mode II, and how far "
            "it strays in mode I.",
            chart_page({opened, slid, turn})});
  return rows;
}

}  // namespace fracfarm::verification
