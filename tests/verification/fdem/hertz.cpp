// FD-9: a round punch pressed on a rigid flat: width and pressure of the contact.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/contact_cases.hpp"
#include "tests/verification/fdem/two_bodies.hpp"

namespace fracfarm::verification {
namespace {

constexpr double b = 1e-3, radius = 0.1, size = 10 * b;  // m: half width wanted, about; of the punch's face; of the punch
constexpr double young = 20e9, poisson = 0.25, density = 2500.0;
const double stiff = young / (1.0 - poisson * poisson);  // E* against a rigid flat
constexpr double approach = 13.5e-6;                     // m, of the punch's top: enough for the half width wanted
const Material stone = cohesive(density, young, poisson, {0.0, never, never, never, never});

// Fine up to `fine`, then growing by `growth` to `end`.
std::vector<double> graded(double part, double fine, double growth, double end) {
  std::vector<double> places{0.0};
  double step = part;
  while (places.back() < end - 0.5 * step) {
    if (places.back() > fine) step *= growth;
    places.push_back(places.back() + step);
  }
  for (double& place : places) place *= end / places.back();
  return places;
}

// Half of the punch, its axis at x = 0, its lower face curved.
TriangleMesh half_punch(double part) {
  const std::vector<double> x = graded(part, 1.5 * b, 1.2, size), z = graded(part, 0.7 * b, 1.2, size);
  TriangleMesh mesh = crossed_mesh(x, z);
  for (auto& node : mesh.nodes) node[1] += 0.5 * node[0] * node[0] / radius * (1.0 - node[1] / size);
  return mesh;
}

struct Pressed {
  double load = 0.0, half_width = 0.0, middle = 0.0;  // N/m, m, share of the load within half of the half width
};

// What the flat bears, from the forces on the punch's lower corners: a pressure like sqrt(1 - x^2/b^2) has the second moment P b^2 / 4.
Pressed pressed(const Run<double>& run, int triangles) {
  double sum = 0.0, second = 0.0, middle = 0.0;
  for (int corner = 0; corner < 3 * triangles; ++corner) {
    const auto& nodes = run.body().mesh.triangles[static_cast<std::size_t>(corner / 3)];
    const auto& at = run.body().mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(corner % 3)])];
    if (at[1] > 0.2 * size) continue;
    const double force = run.fdem().state().extra[fdem::in_row(run.fdem().plan().corner_of(corner), 1)];
    sum += force, second += force * at[0] * at[0];
    if (at[0] < 0.5 * b) middle += force;
  }
  return {2.0 * sum, std::sqrt(4.0 * second / sum), middle / sum};
}

Pressed press(double part, double penalty, Desk& desk) {
  const TriangleMesh punch = half_punch(part);
  const int triangles = static_cast<int>(punch.triangles.size());
  fdem::Body body = two_bodies(punch, crossed_mesh(graded(part, 1.5 * b, 1.2, size), {-part, 0.0}), stone);
  std::vector<fdem::Corner> flat;
  for (int corner = 3 * triangles; corner < static_cast<int>(3 * body.mesh.triangles.size()); ++corner) flat.push_back(corner);
  std::vector<fdem::Corner> axis;
  for (const fdem::Corner corner : corners_where(punch, at_x(0.0))) axis.push_back(corner);
  std::vector<fdem::Corner> held_x = flat;
  held_x.insert(held_x.end(), axis.begin(), axis.end());
  body.told.push_back(held(held_x, Axis::x)), body.told.push_back(held(flat, Axis::z));
  const double period = 4.0 * size / std::sqrt(young / density), ramp = 6.0 * period;
  body.told.push_back({corners_where(punch, at_z(size)), Axis::z,
                       [ramp](double t) { return t < 0.0 || t > ramp ? 0.0 : -approach * 6.0 * t / ramp * (1.0 - t / ramp) / ramp; },
                       std::nullopt});
  FdemSettings settings = reference_settings(part);
  settings.contact_penalty = penalty;
  Run<double> run(std::move(body), settings, 0.6);
  if (!run.start()) return {};
  while (run.time() < ramp) {
    run.step();
    if (run.n() % 500 == 0) desk.progress("pressing", run.time() / (ramp + period));
  }
  Pressed mean;
  int count = 0;
  while (run.time() < ramp + period) {
    run.step();
    if (run.n() % 20 != 0) continue;
    const Pressed now = pressed(run, triangles);
    mean.load += now.load, mean.half_width += now.half_width, mean.middle += now.middle, ++count;
  }
  return {mean.load / count, mean.half_width / count, mean.middle / count};
}

}  // namespace

std::vector<Row> hertz(Desk& desk) {
  const auto wanted = [](const Pressed& ours) { return std::sqrt(4.0 * ours.load * radius / (std::numbers::pi * stiff)); };
  const Pressed ours = press(b / 16.0, 10.0, desk), soft = press(b / 16.0, 1.0, desk);
  const double width = wanted(ours), r = 0.5 * b / width, middle = (std::asin(r) + r * std::sqrt(1.0 - r * r)) * 2.0 / std::numbers::pi;
  return {compare("half width", "m", width, ours.half_width, 0.03),
          compare("largest pressure", "Pa", 0.5 * stiff * width / radius, 2.0 * ours.load / (std::numbers::pi * ours.half_width), 0.03),
          compare("share of the load in the middle half", "1", middle, ours.middle, 0.03),
          report("half width with a penalty of 1 E, over Hertz's", "1", soft.half_width / wanted(soft),
                 "that penalty is a skin half an element thick")};
}

}  // namespace fracfarm::verification
