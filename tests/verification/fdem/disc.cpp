// FD-11: a disc between two jaws.
#include "tests/verification/fdem/disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "common/base/random.hpp"
#include "common/picture/mesh_picture.hpp"
#include "solver/fdem/mesh/assemble.hpp"
#include "solver/fdem/mesh/triangulation.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;

// Rings inwards from the rim.
std::vector<std::array<double, 2>> rings(double radius, double element_size, RandomStream& random) {
  std::vector<std::array<double, 2>> points;
  const int count = static_cast<int>(std::lround(radius / (0.87 * element_size)));
  for (int ring = count; ring > 0; --ring) {
    const double r = radius * ring / count;
    const int around = static_cast<int>(std::lround(2.0 * std::numbers::pi * r / element_size));
    const double shake = ring == count ? 0.0 : 0.25 * element_size, turn = random.uniform(0.0, 2.0 * std::numbers::pi);
    for (int i = 0; i < around; ++i) {
      const double angle = turn + 2.0 * std::numbers::pi * i / around;
      points.push_back(
          {radius + r * std::cos(angle) + random.uniform(-shake, shake), radius + r * std::sin(angle) + random.uniform(-shake, shake)});
    }
  }
  points.push_back({radius, radius});
  return points;
}

constexpr double radius = 0.025, h = 0.00125;  // m
constexpr double half_angle = 8.0;             // degrees, of a jaw
constexpr double speed = 0.05, rise = 5e-5;    // m/s, of each jaw; s
const Cohesion strength{0.6, 5e6, 60e6, 3.0, 150.0};
const Material stone = cohesive(2500.0, 20e9, 0.25, strength);

std::vector<fdem::Corner> jaw(const TriangleMesh& mesh, bool top) {
  const double reach = std::sin(half_angle * std::numbers::pi / 180.0) * radius;
  return corners_where(mesh, [=](double x, double z) {
    return std::abs(std::hypot(x - radius, z - radius) - radius) < 1e-9 * radius + 1e-9 && std::abs(x - radius) <= reach + 0.51 * h &&
           (z > radius) == top;
  });
}

struct Pressed {
  double peak = 0.0;        // N/m
  double half_width = 0.0;  // m, of a jaw
  double kinetic = 0.0;     // over the work, when nine tenths of the peak are reached: at the peak the crack runs already
  double crack = 0.0;       // share of the diameter between the jaws along which joints near the middle line are broken, at the end
  TriangleMesh mesh;
  std::vector<float> damage;
  Line curve;
};

double crack_share(const TriangleMesh& mesh, const std::vector<float>& damage) {
  std::vector<char> cut(40, 0);
  for (Index e = 0; e < damage.size(); ++e) {
    const auto &a = mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][0])], &b = mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][1])];
    const double x = 0.5 * (a[0] + b[0]), z = 0.5 * (a[1] + b[1]);
    if (damage[e] >= 1.0F && std::abs(x - radius) < 0.2 * radius)
      cut[static_cast<Index>(std::clamp(z / (2.0 * radius), 0.0, 0.999) * 40.0)] = 1;
  }
  return static_cast<double>(std::count(cut.begin(), cut.end(), 1)) / 40.0;
}

Pressed press(Desk& desk, std::uint64_t seed) {
  Pressed out;
  fdem::Body body;
  body.mesh = out.mesh = disc_mesh(radius, h, seed), body.materials = {stone};
  for (const bool top : {true, false}) {
    auto corners = jaw(body.mesh, top);
    for (const fdem::Corner corner : corners)
      out.half_width = std::max(
          out.half_width,
          std::abs(
              body.mesh.nodes[static_cast<Index>(body.mesh.triangles[static_cast<Index>(corner / 3)][static_cast<Index>(corner % 3)])][0] -
              radius));
    body.told.push_back({std::move(corners), Axis::z, [top](double t) { return (top ? -speed : speed) * std::clamp(t / rise, 0.0, 1.0); },
                         top ? Side::top : Side::bottom});
  }
  body.side_length[static_cast<Index>(Side::top)] = body.side_length[static_cast<Index>(Side::bottom)] = 1.0;
  FdemSettings settings;
  settings.element_size = h;
  Run<float> run(std::move(body), settings);
  if (!run.start()) return out;
  out.curve.name = fmt::format("mesh {}", seed), out.curve.colour = palette[(seed - 1) % std::size(palette)];
  std::vector<double> kinetic;
  constexpr double limit = 2e-3;
  while (run.time() < limit) {
    run.steps(50);
    const SampleRow row = run.sample();
    const double force = -0.5 * (row.reaction[static_cast<Index>(Side::top)] + row.reaction[static_cast<Index>(Side::bottom)]);
    out.peak = std::max(out.peak, force), kinetic.push_back(row.kinetic_energy / row.external_work);
    out.curve.x.push_back(run.time()), out.curve.y.push_back(force);
    desk.progress(fmt::format("mesh {}", seed), run.time() / limit);
    if (out.peak > 1e4 && force < 0.4 * out.peak) break;
  }
  const auto near_peak = std::find_if(out.curve.y.begin(), out.curve.y.end(), [&](double force) { return force >= 0.9 * out.peak; });
  out.kinetic = kinetic[static_cast<Index>(near_peak - out.curve.y.begin())];
  run.steps(static_cast<long long>(1e-5 / run.dt()));
  out.damage = run.fdem().stored_damage();
  out.crack = crack_share(out.mesh, out.damage);
  return out;
}

}  // namespace

TriangleMesh disc_mesh(double disc_radius, double element_size, std::uint64_t seed) {
  RandomStream random(seed, 1, 11);
  const double frame = 0.5 * disc_radius;  // the disc lies inside the triangulated square
  const fdem::Lattice lattice(2.0 * (disc_radius + frame), 2.0 * (disc_radius + frame), {});
  fdem::Triangulation triangulation(lattice.upper_right());
  fdem::Soup soup;
  constexpr int frame_corners = 4;  // the first points of a triangulation
  int near = 0;
  for (const auto& point : rings(disc_radius, element_size, random)) {
    const int number = triangulation.insert(lattice.nearest(point[0] + frame, point[1] + frame), near);
    near = triangulation.triangle_of(number);
    soup.nodes.push_back(point);
  }
  for (const fdem::Triangle& triangle : triangulation.triangles()) {
    const auto& [i, j, k] = triangle.corner;
    if (std::min({i, j, k}) >= frame_corners) soup.triangles.push_back({i - frame_corners, j - frame_corners, k - frame_corners});
  }
  return fdem::assemble(soup).value();
}

std::vector<Row> brazilian_disc(Desk& desk) {
  std::vector<Row> rows;
  std::vector<Line> curves;
  double sum = 0.0, low = INFINITY, high = 0.0, kinetic = 0.0;
  constexpr int meshes = 5;
  for (int seed = 1; seed <= meshes; ++seed) {
    desk.part((seed - 1.0) / meshes, 1.0 / meshes);
    Pressed pressed = press(desk, static_cast<std::uint64_t>(seed));
    // Of a load spread over a jaw: Tang (1994).
    const double width = pressed.half_width / radius, spread = std::pow(1.0 - width * width, 1.5);
    const double stress = pressed.peak / (std::numbers::pi * radius) * spread;
    rows.push_back(report(fmt::format("mesh {}: tensile strength that the disc shows", seed), "Pa", stress,
                          fmt::format("2P/(πDt) × {:.3f} for the jaw; {:.0f} % of the middle line broken", spread, 100.0 * pressed.crack)));
    sum += stress, low = std::min(low, stress), high = std::max(high, stress), kinetic = std::max(kinetic, pressed.kinetic);
    curves.push_back(std::move(pressed.curve));
    if (seed == 1)
      desk.add({"brazilian_disc", "FD-11: joints of the first disc after its peak, red where broken.",
                picture::draw_mesh(pressed.mesh, pressed.damage, 560)});
  }
  rows.push_back(compare("mean of the five meshes", "Pa", strength.tensile_strength, sum / meshes, 0.1,
                         fmt::format("{:.3g} to {:.3g}, {:.1f} % apart", low, high, 100.0 * (high - low) * meshes / sum)));
  rows.push_back(between("kinetic energy over the work at nine tenths of the peak, most", "1", {0.0, 0.01}, kinetic, 0.0));
  desk.add({"brazilian_force", "FD-11: force of the jaws on five meshes.", chart_page({{"", {"time", "s"}, {"force", "N/m"}, curves}})});
  return rows;
}

}  // namespace fracfarm::verification
