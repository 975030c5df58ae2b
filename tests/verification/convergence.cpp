// PF-11: w_0 fixed, h -> h/8 with dt in proportion. Errors are root mean squares over the nodes of the coarsest grid.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double side = 0.016;         // m
constexpr double width = side / 16.0;  // w_0, m
constexpr int coarsest = 16, grids = 5;

int cells_of(int level) { return coarsest << level; }

Scene square(const Material& material, int level) {
  Scene scene = plain_scene(material, cells_of(level), cells_of(level), side / cells_of(level));
  scene.phase_field.length_scale = {LengthScale::Kind::metres, width};
  return scene;
}

void between_rollers(Scene& scene) {
  for (const Side where : all_sides) set_load(scene, where, roller(side));
}

// Values of a field at the nodes of the coarsest grid.
std::vector<double> coarse(const Bench& bench, const phasefield::Field<double>& field, int level) {
  std::vector<double> values;
  for (int j = 0; j <= coarsest; ++j)
    for (int i = 0; i <= coarsest; ++i) values.push_back(field[bench.at(i << level, j << level)]);
  return values;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Study {
  std::string name;
  std::vector<double> error;  // by level
  // Of the least-squares line through log2 of the errors.
  double slope() const {
    const double n = static_cast<double>(error.size()), middle = 0.5 * (n - 1.0);
    double up = 0.0, across = 0.0;
    for (std::size_t k = 0; k < error.size(); ++k) {
      const double x = static_cast<double>(k) - middle;
      up -= x * std::log2(error[k]), across += x * x;
    }
    return up / across;
  }
};

// psi* is given, H follows from the equation: what the grid's psi misses.
Study static_damage() {
  const Material& pbx = *find_material("pbx");
  const double a = pi / side, b = 2.0 * pi / side;
  const auto wave = [&](double x, double z) { return std::cos(a * x) * std::cos(b * z); };
  Study study{"psi of a given H", {}};
  for (int level = 0; level < 4; ++level) {
    Bench bench(square(pbx, level));
    bench.model.damage_tolerance = 1e-13;
    const double h = bench.model.grid.hx;
    std::vector<double> exact;
    for (int j = 0; j < cells_of(level); ++j)
      for (int i = 0; i < cells_of(level); ++i)
        for (int corner = 0; corner < 4; ++corner) {
          const double w = wave((i + corner % 2) * h, (j + corner / 2) * h), psi = 0.4 + 0.3 * w;
          bench.set_history(i, j, corner, pbx.Gc * (psi / width + width * (a * a + b * b) * 0.3 * w) / (2.0 * (1.0 - psi)));
        }
    bench.respond();
    for (int j = 0; j <= coarsest; ++j)
      for (int i = 0; i <= coarsest; ++i) exact.push_back(0.4 + 0.3 * wave(i * side / coarsest, j * side / coarsest));
    study.error.push_back(distance(coarse(bench, bench.state.psi, level), exact));
  }
  return study;
}

// A standing P wave and a standing S wave between rollers.
struct Waves {
  double a = 2.0 * pi / side, b = pi / side;  // 1/m
  double amplitude;                           // of the strains
  std::pair<double, double> at(double x, double z, double p = 1.0, double s = 1.0) const {
    const double k = amplitude / (a * a + b * b);
    const double sc = std::sin(a * x) * std::cos(b * z), cs = std::cos(a * x) * std::sin(b * z);
    return {k * (a * p + b * s) * sc, k * (b * p - a * s) * cs};
  }
};

// The waves run to the same instant on every grid: at rest and displaced at t = 0, or (pushed) moving and undeformed, so that damage
// grows from nothing.
Bench run_waves(const Material& material, const Waves& waves, int level, double time, double push = 0.0) {
  Scene scene = square(material, level);
  between_rollers(scene);
  Bench bench(scene);
  bench.model.damage_tolerance = 1e-11;
  bench.model.rules.work_where_it_moves = false;
  if (push > 0.0)
    bench.set_velocity([&](double x, double z) { return waves.at(x, z, push, push); });
  else
    bench.set_displacement([&](double x, double z) { return waves.at(x, z); });
  const int steps = static_cast<int>(std::ceil(
                        time / (0.9 * side / coarsest / std::sqrt((material.elasticity.C11 + material.elasticity.C55) / material.density))))
                    << level;
  const double dt = time / steps;
  bench.release(dt);
  for (int n = 0; n < steps; ++n)
    if (!phasefield::step(bench.model, bench.state, bench.scratch, bench.kernels, n, dt))
      bench.state.psi.assign(bench.state.psi.size(), NAN);
  return bench;
}

Study elastic_waves() {
  const Material pbx = tough("pbx");
  const Elasticity& C = pbx.elasticity;
  const Waves waves{.amplitude = 1e-6};
  const double k = std::hypot(waves.a, waves.b), period = 2.0 * pi / (k * std::sqrt(C.C11 / pbx.density)), time = 1.3 * period;
  const double p = std::cos(k * std::sqrt(C.C11 / pbx.density) * time), s = std::cos(k * std::sqrt(C.C55 / pbx.density) * time);
  Study study{"elastic waves", {}};
  for (int level = 0; level < 4; ++level) {
    const Bench bench = run_waves(pbx, waves, level, time);
    std::vector<double> exact;
    for (int j = 0; j <= coarsest; ++j)
      for (int i = 0; i <= coarsest; ++i) exact.push_back(waves.at(i * side / coarsest, j * side / coarsest, p, s).first);
    study.error.push_back(distance(coarse(bench, bench.state.ux, level), exact) / waves.at(0.25 * side, 0.0).first);
  }
  return study;
}

// The same waves strong enough to damage: each grid against the next finer one.
std::array<Study, 2> damaging_waves(Desk& desk, double& largest_psi) {
  const Material& pbx = *find_material("pbx");
  const double strain = std::sqrt(pbx.Gc / (3.0 * pbx.elasticity.C33 * width));
  const Waves waves{.amplitude = strain};
  const double time = 0.4 * side / std::sqrt(pbx.elasticity.C11 / pbx.density);
  const double push = std::hypot(waves.a, waves.b) * std::sqrt(pbx.elasticity.C11 / pbx.density);  // 1/s: the waves' frequency
  std::array<Study, 2> studies{Study{"damaging waves: psi", {}}, Study{"damaging waves: u", {}}};
  std::vector<double> psi, u;
  for (int level = 0; level < grids; ++level) {
    desk.progress("damaging waves", level / 5.0);
    const Bench bench = run_waves(pbx, waves, level, time, push);
    const std::vector<double> finer_psi = coarse(bench, bench.state.psi, level), finer_u = coarse(bench, bench.state.ux, level);
    if (level > 0) studies[0].error.push_back(distance(psi, finer_psi));
    if (level > 0) studies[1].error.push_back(distance(u, finer_u) / waves.at(0.25 * side, 0.0).first);
    psi = finer_psi, u = finer_u;
  }
  largest_psi = *std::max_element(psi.begin(), psi.end());
  return studies;
}

Line line_of(const Study& study, picture::Colour colour) {
  Line line{study.name, colour, {}, {}};
  for (std::size_t k = 0; k < study.error.size(); ++k) {
    line.x.push_back(static_cast<double>(k));
    line.y.push_back(std::log2(study.error[k] / study.error[0]));
  }
  return line;
}

}  // namespace

std::vector<Row> convergence(Desk& desk) {
  double largest_psi = 0.0;
  const auto damaging = damaging_waves(desk, largest_psi);
  const std::vector<Study> studies{static_damage(), elastic_waves(), damaging[0], damaging[1]};
  std::vector<Row> rows;
  Chart chart{"PF-11 error against grid", {"log2(h0/h)", ""}, {"log2(error/error at h0)", ""}, {}};
  for (std::size_t k = 0; k < studies.size(); ++k) {
    std::string errors;
    for (const double e : studies[k].error) errors += fmt::format("{}{:.2e}", errors.empty() ? "" : ", ", e);
    rows.push_back(between(studies[k].name + ": slope", "1", {1.8, INFINITY}, studies[k].slope(), 0.0, "errors " + errors));
    chart.lines.push_back(line_of(studies[k], palette[k]));
    chart.lines.back().name = std::array{"H given", "elastic", "damaging: psi", "damaging: u"}[k];  // room for all in the legend
  }
  rows[2].note += fmt::format("; psi up to {:.3f}", largest_psi);
  chart.lines.push_back({"slope 2", picture::grey, {0.0, 3.0}, {0.0, -6.0}});
  desk.add({"convergence", "Error against grid, w0 fixed and dt in proportion to h; second order falls by 2 on this scale at each halving.",
            chart_page({chart})});
  return rows;
}

}  // namespace fracfarm::verification
