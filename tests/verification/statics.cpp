// PF-1 to PF-4 and PF-12: one state at a time, no time step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/random.hpp"
#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"

namespace fracfarm::verification {
namespace {

constexpr double tight = 2e-15;  // damage tolerance of these rows: rounding, not the solver, is what is left

double width_of(const Material& material) { return 0.5 * material.characteristic_width; }

struct Response {
  double stress, psi;
};

// One element stretched to e_zz, its sides held or contracting freely.
Response stretched(const Material& material, double zz, bool free_sides) {
  Bench bench(plain_scene(material, 1, 1, dataset_h));
  bench.model.damage_tolerance = tight;
  const double xx = free_sides ? -material.elasticity.C13 / material.elasticity.C11 * zz : 0.0;
  bench.set_displacement([&](double x, double z) { return std::pair{xx * x, zz * z}; });
  const double stress = bench.respond().zz / bench.area();
  return {stress, bench.state.psi[bench.at(0, 0)]};
}

// Largest value of a smooth function with one maximum in [a, b], by golden sections.
template <class F>
double largest(F f, double a, double b) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double c = b - ratio * (b - a), d = a + ratio * (b - a);
  for (int k = 0; k < 60; ++k) {
    (f(c) > f(d) ? b : a) = f(c) > f(d) ? d : c;
    c = b - ratio * (b - a), d = a + ratio * (b - a);
  }
  return f(0.5 * (a + b));
}

// 1-D: 120 elements in a row, psi = 1 held on the given columns of nodes, nothing strained.
Bench relaxed_strip(double h, std::initializer_list<int> held) {
  Bench bench(plain_scene(*find_material("pbx"), 120, 1, h));
  bench.model.damage_tolerance = tight;
  for (const int column : held)
    for (const int row : {0, 1}) bench.model.pinned.push_back(bench.at(column, row));
  bench.remake();
  for (const std::size_t n : bench.model.pinned) bench.state.psi[n] = bench.state.psi_previous[n] = 1.0;
  bench.respond();
  return bench;
}

constexpr std::array<double, 4> cell_shares{0.25, 0.5, 0.984251968503937, 2.0};  // h / w_0

double toughness(double h, std::initializer_list<int> held) {
  Bench bench = relaxed_strip(h, held);
  const phasefield::SurfaceSum sum = bench.surface();
  return (sum.local + sum.gradient) / bench.model.grid.hz;
}

void fill_history(Bench& bench, RandomStream& random, double base) {
  for (int corner = 0; corner < 4; ++corner)
    for (int j = 0; j < bench.model.grid.cells_z(); ++j)
      for (int i = 0; i < bench.model.grid.cells_x(); ++i)
        bench.set_history(i, j, corner, bench.history(i, j, corner) + base * std::pow(10.0, random.uniform(-6.0, 3.0)));
}

// Uniform shear stress, uniaxial strain, and plane strain with stress-free sides: sigma of the hardening line, from the equations alone.
struct Metal {
  double K, mu, yield, H;
  double hardened(double q) const { return q > yield ? yield + H * (q - yield) / (3.0 * mu + H) : q; }
  double shear(double gamma) const { return hardened(std::sqrt(3.0) * mu * gamma) / std::sqrt(3.0); }
  double confined(double e) const { return K * e + hardened(2.0 * mu * e) * 2.0 / 3.0; }
};

double secant_stress(const Material& material, double xx, double zz, double xz, bool shear, double* side = nullptr) {
  Scene scene = plain_scene(material, 1, 1, dataset_h);
  scene.phase_field.plasticity = PlasticityModel::secant;
  Bench bench(scene);
  bench.set_displacement([&](double x, double z) { return std::pair{xx * x + xz * z, zz * z}; });
  const phasefield::StressSum sum = bench.respond();
  if (side) *side = sum.xx / bench.area();
  if (!shear) return sum.zz / bench.area();
  return (bench.scratch.fx[bench.at(0, 0)] + bench.scratch.fx[bench.at(1, 0)]) / bench.model.grid.hx;  // shear force on the lower side
}

// Contraction at which the sides carry no stress, by secant iterations on the solver's own answer.
double free_contraction(const Material& material, double zz) {
  double a = 0.0, b = -zz, fa = 0.0, fb = 0.0;
  secant_stress(material, a, zz, 0.0, false, &fa);
  for (int k = 0; k < 60; ++k) {
    secant_stress(material, b, zz, 0.0, false, &fb);
    if (std::abs(fb) < 1e-3 || fb == fa) break;
    const double next = b - fb * (b - a) / (fb - fa);
    a = b, fa = fb, b = next;
  }
  return b;
}

}  // namespace

std::vector<Row> homogeneous_peak() {
  std::vector<Row> rows;
  for (const char* name : {"pbx", "shale"}) {
    const Material& m = *find_material(name);
    const double C33 = m.elasticity.C33, w0 = width_of(m);
    for (const bool free_sides : {false, true}) {
      const double modulus = free_sides ? C33 - m.elasticity.C13 * m.elasticity.C13 / m.elasticity.C11 : C33;
      const double strain = std::sqrt(m.Gc / (3.0 * C33 * w0));
      const double peak = 3.0 * std::sqrt(3.0) / 16.0 * modulus * std::sqrt(m.Gc / (C33 * w0));
      const std::string sides = free_sides ? "sides free (Phi+ clips e_xx < 0: driven by C33, carried by E')" : "sides held (E' = C33)";
      const double found = largest([&](double e) { return stretched(m, e, free_sides).stress; }, 0.5 * strain, 2.0 * strain);
      rows.push_back(compare(fmt::format("{} peak stress, {}", name, sides), "Pa", peak, found, 1e-10));
      rows.push_back(
          compare(fmt::format("{} stress at the peak strain", name), "Pa", peak, stretched(m, strain, free_sides).stress, 1e-10));
      rows.push_back(compare(fmt::format("{} psi at the peak strain", name), "1", 0.25, stretched(m, strain, free_sides).psi, 1e-10));
    }
  }
  return rows;
}

std::vector<Row> static_profile() {
  std::vector<Row> rows;
  const double w0 = width_of(*find_material("pbx"));
  for (const double s : cell_shares) {
    const double lambda = 1.0 + 0.5 * s * s - s * std::sqrt(1.0 + 0.25 * s * s);
    const Bench bench = relaxed_strip(s * w0, {60});
    double worst = 0.0;  // against lambda^|k| between the mirrors that the strip's ends are
    for (int k = 0; k <= 60; ++k) {
      const double mirrored = (std::pow(lambda, k) + std::pow(lambda, 120 - k)) / (1.0 + std::pow(lambda, 120));
      for (const int column : {60 - k, 60 + k}) worst = std::max(worst, std::abs(bench.state.psi[bench.at(column, 0)] - mirrored));
    }
    rows.push_back(compare(fmt::format("largest error of psi, h/w0 = {:.3g}", s), "1", 0.0, worst, 1e-12));
  }
  return rows;
}

std::vector<Row> discrete_toughness() {
  std::vector<Row> rows;
  const Material& pbx = *find_material("pbx");
  for (const double s : cell_shares) {
    const double root = std::sqrt(1.0 + 0.25 * s * s), h = s * width_of(pbx);
    rows.push_back(compare(fmt::format("one column of nodes, h/w0 = {:.3g}", s), "J/m2", pbx.Gc * root, toughness(h, {60}), 1e-12));
    rows.push_back(
        compare(fmt::format("one column of elements, h/w0 = {:.3g}", s), "J/m2", pbx.Gc * (0.5 * s + root), toughness(h, {60, 61}), 1e-12));
  }
  return rows;
}

std::vector<Row> bounds() {
  double outside = 0.0, fell = 0.0;
  const Material& pbx = *find_material("pbx");
  for (int field = 0; field < 10000; ++field) {
    RandomStream random(2026, static_cast<std::uint64_t>(field), 4);
    Bench bench(plain_scene(pbx, 6, 5, dataset_h * random.uniform(0.1, 3.0)));
    bench.model.damage_tolerance = tight;
    fill_history(bench, random, pbx.Gc / width_of(pbx));
    bench.respond();
    const phasefield::Field<double> first = bench.state.psi;
    fill_history(bench, random, pbx.Gc / width_of(pbx));
    bench.respond();
    for (int j = 0; j < bench.model.grid.rows; ++j)
      for (int i = 0; i < bench.model.grid.columns; ++i) {
        const double before = first[bench.at(i, j)], after = bench.state.psi[bench.at(i, j)];
        outside = std::max({outside, -before, before - 1.0, -after, after - 1.0});
        fell = std::max(fell, before - after);
      }
  }
  const std::string note = "psi solved to rounding (2e-15) here; a run stops at 1e-8, within which its psi may leave the bounds";
  return {compare("largest excursion of psi outside [0, 1], 2e4 solves", "1", 0.0, outside, 0.0, note),
          compare("largest fall of psi where H grew, 1e4 pairs", "1", 0.0, fell, 0.0, note)};
}

std::vector<Row> hardening_curve() {
  std::vector<Row> rows;
  for (const char* name : {"tungsten", "aluminum", "steel"}) {
    const Material m = tough(name);
    const Elasticity& C = m.elasticity;
    const Metal metal{C.C13 + 2.0 / 3.0 * C.C55, C.C55, m.plasticity->yield, m.plasticity->hardening};
    double shear = 0.0, confined = 0.0, plane = 0.0;
    for (const double factor : {0.5, 0.99, 1.01, 1.5, 3.0, 10.0, 30.0}) {
      const double q = factor * metal.yield, gamma = q / (std::sqrt(3.0) * metal.mu), e = q / (2.0 * metal.mu);
      const auto miss = [](double ours, double target) { return std::abs(ours / target - 1.0); };
      shear = std::max(shear, miss(secant_stress(m, 0.0, 0.0, gamma, true), metal.shear(gamma)));
      confined = std::max(confined, miss(secant_stress(m, 0.0, e, 0.0, false), metal.confined(e)));
      // Sides free: the mean stress is sigma/2 in the plane, so the deviator gives |sigma_zz| from q and the volume change alone.
      const double xx = free_contraction(m, e), volume = xx + e;
      const double deviator = std::sqrt(xx * xx + e * e - volume * volume / 3.0), trial = std::sqrt(6.0) * metal.mu * deviator;
      const double target = metal.K * volume + 2.0 * metal.mu * metal.hardened(trial) / trial * (e - volume / 3.0);
      plane = std::max(plane, miss(secant_stress(m, xx, e, 0.0, false), target));
    }
    rows.push_back(compare(fmt::format("{}: worst of pure shear, 0.5 to 30 yields", name), "1", 0.0, shear, 1e-8));
    rows.push_back(compare(fmt::format("{}: worst of uniaxial strain", name), "1", 0.0, confined, 1e-8));
    rows.push_back(compare(fmt::format("{}: worst of plane-strain tension, sides free", name), "1", 0.0, plane, 1e-8));
  }
  return rows;
}

}  // namespace fracfarm::verification
