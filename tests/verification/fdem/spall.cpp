// FD-5: two tensile pulses meet in a bar that bears one of them but not both.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "solver/fdem/materials.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;

constexpr double a = 0.001, length = 300 * a;  // m: squares of four triangles
constexpr double young = 20e9, density = 2500.0, pulse = 10e6, strength = 1.98 * pulse;
constexpr double penalty = 100.0;                                              // E/h
const double modulus = young / (1.0 + (1.0 + std::numbers::sqrt2) / penalty);  // joints in series, as in FD-3
const double c = std::sqrt(modulus / density), impedance = density * c;
const double rise = 15 * a / c, fall = 130 * a / c;  // s

// Up, and slowly down again: behind a crack that opens under flat pulses the one that crossed and the rest of the other still add up to
// the strength, and the bar goes on breaking.
double shape(double t) {
  if (t <= 0.0 || t >= rise + fall) return 0.0;
  return t < rise ? 0.5 - 0.5 * std::cos(std::numbers::pi * t / rise) : 1.0 - (t - rise) / fall;
}
const double impulse = 0.5 * pulse * (rise + fall);  // Pa s

const Material stone = cohesive(density, young, 0.0, {0.6, strength, 1e9, 5.0, 1e6});

struct Expected {
  double opens, breaks;  // s, after both pulses reach the place
  double across;         // Pa s: what the joint still carries over
};

// The joint between two half bars: each face radiates, opening' = 2 (2 s - sigma(opening)) / (rho c).
Expected expected() {
  const law::Joint<double> law = fdem::joint_law(stone, stone, reference_settings(a));
  Expected out{};
  double opening = 0.0, damage = 0.0, t = 0.0;
  constexpr double dt = 2e-11;
  while (damage < 1.0 && t < 1e-3) {
    const auto answer = law::answer<law::Munjiza>(law, law::Opening<double>{opening, 0.0}, damage);
    if (answer.damage > 0.0 && damage == 0.0) out.opens = t;
    damage = answer.damage;
    out.across += dt * answer.normal;
    opening += dt * 2.0 * (2.0 * pulse * shape(t) - answer.normal) / impedance;
    t += dt;
  }
  out.breaks = t;
  return out;
}

struct Outcome {
  double opens = 0.0, breaks = 0.0;  // s
  double place = 0.0;                // m, mean of the broken joints
  double left = 0.0, right = 0.0;    // m, the outermost of them
  double momentum = 0.0;             // Pa s: of the left part over the bar's thickness
};

Outcome pull_apart(double delay) {
  fdem::Body body;
  body.mesh = crossed_mesh(parts_of(0.0, length, 300), {0.0, a}), body.materials = {stone};
  auto rollers = corners_where(body.mesh, at_z(0.0));
  for (const fdem::Corner corner : corners_where(body.mesh, at_z(a))) rollers.push_back(corner);
  body.told.push_back(held(std::move(rollers), Axis::z));
  body.pulls.push_back(pull_on(body.mesh, at_x(0.0), {-pulse, 0.0}, shape));
  body.pulls.push_back(pull_on(body.mesh, at_x(length), {pulse, 0.0}, [delay](double t) { return shape(t - delay); }));
  FdemSettings settings = reference_settings(a);
  settings.viscosity = 0.0;  // it would smear the pulses on their way
  Run<double> run(std::move(body), settings, 0.5);
  Outcome out;
  if (!run.start()) return out;
  const double end = 0.5 * length / c + delay + rise + fall;
  const auto& damage = run.fdem().state().damage;
  while (run.time() < end) {
    run.step();
    if (out.opens == 0.0 && std::any_of(damage.begin(), damage.end(), [](double d) { return d > 0.0; })) out.opens = run.time();
  }
  const TriangleMesh& mesh = run.body().mesh;
  const auto times = run.fdem().break_time();
  out.left = length, out.breaks = INFINITY;
  int count = 0;
  for (Index e = 0; e < times.size(); ++e) {
    if (std::isnan(times[e])) continue;
    const double x =
        0.5 * (mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][0])][0] + mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][1])][0]);
    out.place += x, ++count;
    out.left = std::min(out.left, x), out.right = std::max(out.right, x), out.breaks = std::min(out.breaks, times[e]);
  }
  out.place /= count;
  for (fdem::Corner corner = 0; corner < run.corners(); ++corner) {
    const auto& triangle = mesh.triangles[static_cast<Index>(corner / 3)];
    double x = 0.0;
    for (const int node : triangle) x += mesh.nodes[static_cast<Index>(node)][0] / 3.0;
    if (x < out.place) out.momentum += run.mass(corner) * run.v(corner, 0) / a;
  }
  return out;
}

}  // namespace

std::vector<Row> spall(Desk&) {
  const Expected target = expected();
  std::vector<Row> rows;
  for (const double squares : {0.0, 20.0}) {
    const double delay = squares * a / c, meet = 0.5 * (length / c + delay);
    const Outcome ours = pull_apart(delay);
    const std::string what = squares == 0.0 ? "pulses at once: " : "right pulse 20 squares late: ";
    rows.push_back(compare(what + "place of the crack, in squares", "h", 150.0 + 0.5 * squares, ours.place / a, 0.0,
                           fmt::format("broken from {:.1f} to {:.1f}", ours.left / a, ours.right / a)));
    rows.back().error = std::max(std::abs(ours.left / a - rows.back().target), std::abs(ours.right / a - rows.back().target));
    rows.back().tolerance = 1.0, rows.back().passed = rows.back().error <= 1.0 + 1e-9;
    rows.push_back(compare(what + "time at which it begins to open", "s", meet + target.opens, ours.opens, 0.01,
                           fmt::format("{:+.2f} squares of the wave's way", (ours.opens - meet - target.opens) * c / a)));
    rows.push_back(compare(what + "time at which it is broken", "s", meet + target.breaks, ours.breaks, 0.01));
    rows.push_back(compare(what + "momentum of the left fragment over the bar's thickness", "Pa s", -(impulse - target.across),
                           ours.momentum, 0.01, fmt::format("{:.1f} % of the pulse crosses before", 100.0 * target.across / impulse)));
  }
  return rows;
}

}  // namespace fracfarm::verification
