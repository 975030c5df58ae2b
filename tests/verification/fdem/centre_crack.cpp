// FD-12: a plate with a crack in its middle, drawn out slowly: the stress that it bears against linear elastic fracture mechanics.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "common/picture/mesh_picture.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;

constexpr double width = 0.06, height = 0.12, half_crack = 0.015;  // m
constexpr double young = 20e9, poisson = 0.25, toughness = 10.0;
constexpr double speed = 0.015, rise = 1.5e-4;  // m/s, of each end; s
constexpr double plane_young = young / (1.0 - poisson * poisson);

// As strong as makes E' G / f_t^2, the length of the zone up to a factor, four elements.
Material stone(double h) {
  const double tensile = std::sqrt(plane_young * toughness / (4.0 * h));
  return cohesive(2500.0, young, poisson, {0.6, tensile, 3.5 * tensile, toughness, 10.0 * toughness});
}

// sigma sqrt(pi a) F = sqrt(E' G), F of a finite width (Tada, Paris and Irwin, 1973).
double critical_stress() {
  const double share = 2.0 * half_crack / width, square = share * share;
  const double F = (1.0 - 0.025 * square + 0.06 * square * square) / std::sqrt(std::cos(0.5 * std::numbers::pi * share));
  return std::sqrt(plane_young * toughness / (std::numbers::pi * half_crack)) / F;
}

double ease(double t) {
  const double s = std::clamp(t / rise, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

struct Drawn {
  double peak = 0.0;     // Pa
  double first = 0.0;    // Pa: when the first joint is broken
  double kinetic = 0.0;  // over the work, at the peak
  std::vector<float> damage;
  TriangleMesh mesh;
  Line curve;
};

template <class Real>
Drawn draw(Desk& desk, const std::string& name, fdem::Body body, const FdemSettings& settings) {
  Drawn out;
  body.told.push_back({corners_where(body.mesh, at_z(height)), Axis::z, [](double t) { return speed * ease(t); }, Side::top});
  body.told.push_back({corners_where(body.mesh, at_z(0.0)), Axis::z, [](double t) { return -speed * ease(t); }, Side::bottom});
  out.mesh = body.mesh, out.curve.name = name;
  Run<Real> run(std::move(body), settings);
  if (!run.start()) return out;
  constexpr double limit = 1.2e-3;
  while (run.time() < limit) {
    run.steps(50);
    const SampleRow row = run.sample();
    if (row.stress_zz > out.peak) out.peak = row.stress_zz, out.kinetic = row.kinetic_energy / row.external_work;
    if (out.first == 0.0 && row.fracture_energy > 0.0) {
      const auto times = run.fdem().break_time();
      if (std::any_of(times.begin(), times.end(), [](double t) { return !std::isnan(t); })) out.first = row.stress_zz;
    }
    out.curve.x.push_back(run.time()), out.curve.y.push_back(row.stress_zz);
    desk.progress(name, run.time() / limit);
    if (row.stress_zz < 0.5 * out.peak && out.peak > 0.2 * critical_stress()) break;
  }
  out.damage = run.fdem().stored_damage();
  return out;
}

// The mesher's triangles, all joints awake, fast tier.
Drawn free_path(Desk& desk, double h, std::uint64_t seed) {
  fdem::MeshChoice choice;
  choice.width = width, choice.height = height, choice.element_size = h, choice.seed = seed;
  choice.cracks = {{0.5 * width - half_crack, 0.5 * height, 0.5 * width + half_crack, 0.5 * height}};
  fdem::Body body;
  body.mesh = fdem::make_mesh(choice).value().mesh, body.materials = {stone(h)};
  FdemSettings settings;
  settings.element_size = h;
  return draw<float>(desk, fmt::format("mesher, h = {:g} mm, seed {}", 1e3 * h, seed), std::move(body), settings);
}

// Lines that get farther apart away from `middle`: `fine` up to `until` from it, then a quarter farther each.
std::vector<double> graded(double from, double to, double middle, double fine, double until) {
  std::vector<double> up, places;
  for (const double end : {to, from}) {
    const double room = std::abs(end - middle), way = end > middle ? 1.0 : -1.0;
    std::vector<double> steps;
    double sum = 0.0, step = fine;
    while (sum < room - 1e-12) {
      if (sum >= until) step *= 1.25;
      steps.push_back(step), sum += step;
    }
    const double coarse = room - until, scale = (sum - until) > 0.0 ? coarse / (sum - until) : 1.0;
    double at = 0.0;
    std::vector<double> side;
    for (const double s : steps) at += at < until - 1e-12 ? s : s * scale, side.push_back(middle + way * at);
    if (!side.empty()) side.back() = end;
    if (way > 0.0)
      up = side;
    else
      places.assign(side.rbegin(), side.rend());
  }
  places.push_back(middle);
  places.insert(places.end(), up.begin(), up.end());
  return places;
}

// The right half, on squares of h along the crack's line, where alone there are joints.
Drawn straight_path(Desk& desk, double h) {
  fdem::Body body;
  body.mesh = crossed_mesh(parts_of(0.0, 0.5 * width, static_cast<int>(std::lround(0.5 * width / h))),
                           graded(0.0, height, 0.5 * height, h, 4.0 * h));
  body.materials = {stone(h)};
  body.asleep.assign(body.mesh.edge_nodes.size(), 1);
  for (const int e : edges_where(body.mesh, at_z(0.5 * height))) {
    const auto [a, b] = body.mesh.edge_nodes[static_cast<Index>(e)];
    body.asleep[static_cast<Index>(e)] = 0;
    if (body.mesh.nodes[static_cast<Index>(a)][0] + body.mesh.nodes[static_cast<Index>(b)][0] < 2.0 * half_crack)
      body.mesh.edge_kind[static_cast<Index>(e)] = EdgeKind::crack;
  }
  body.told.push_back(held(corners_where(body.mesh, at_x(0.0)), Axis::x));
  FdemSettings settings = reference_settings(h);
  settings.penalty = 30.0;
  return draw<double>(desk, fmt::format("straight, h = {:g} mm", 1e3 * h), std::move(body), settings);
}

Row row_of(const Drawn& drawn, double target, double tolerance) {
  Row row = compare(drawn.curve.name + ": largest mean stress", "Pa", target, drawn.peak, tolerance,
                    fmt::format("{:+.1f} %; {:+.1f} % when the first joint is broken; kinetic energy at the peak {:.2f} % of the work",
                                100.0 * (drawn.peak / target - 1.0), 100.0 * (drawn.first / target - 1.0), 100.0 * drawn.kinetic));
  if (std::isinf(tolerance)) row.judged = false, row.passed = true;
  return row;
}

constexpr double sizes[]{0.002, 0.001, 0.0005};  // m
constexpr double in_time[]{0.04, 0.16, 0.8};     // of a series
constexpr int seeds = 3;

}  // namespace

std::vector<Row> centre_crack(Desk& desk) {
  const double target = critical_stress();
  std::vector<Row> rows;
  std::vector<Line> curves;
  double begin = 0.0;
  const auto draw_curve = [&](Drawn& drawn) {
    drawn.curve.colour = palette[curves.size() % std::size(palette)];
    curves.push_back(std::move(drawn.curve));
  };
  const auto on = [&](Index size, double part) { desk.part(begin, part * in_time[size]), begin += part * in_time[size]; };
  for (Index size = 0; size < std::size(sizes); ++size) {
    on(size, 0.4);
    Drawn drawn = straight_path(desk, sizes[size]);
    rows.push_back(row_of(drawn, target, size == 2 ? 0.07 : INFINITY));
    draw_curve(drawn);
  }
  double mean[3]{};
  for (Index size = 0; size < std::size(sizes); ++size)
    for (int seed = 1; seed <= seeds; ++seed) {
      on(size, 0.2);
      Drawn drawn = free_path(desk, sizes[size], static_cast<std::uint64_t>(seed));
      mean[size] += drawn.peak / seeds;
      rows.push_back(row_of(drawn, target, INFINITY));
      if (seed > 1) continue;
      draw_curve(drawn);
      if (size == 2)
        desk.add({"centre_crack", "FD-12: one of the mesher's finest plates after its peak, red where joints are broken.",
                  picture::draw_mesh(drawn.mesh, drawn.damage, 420)});
    }
  rows.push_back(between("straight: error at h = 0.5 mm over that at 2 mm", "1", {0.0, 0.75}, rows[2].error / rows[0].error, 0.0));
  rows.push_back(compare("mesher: mean of three, h = 0.5 mm", "Pa", target, mean[2], 0.07));
  rows.push_back(between("mesher: error of the mean at h = 0.5 mm over that at 2 mm", "1", {0.0, 0.75},
                         std::abs(mean[2] - target) / std::abs(mean[0] - target), 0.0));
  desk.add({"centre_crack_stress", "FD-12: mean stress of the plates.", chart_page({{"", {"time", "s"}, {"mean stress", "Pa"}, curves}})});
  return rows;
}

}  // namespace fracfarm::verification
