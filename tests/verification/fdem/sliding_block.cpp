// FD-8: an elastic block that friction slows on an elastic table, and one that is pushed along it.
#include <fmt/format.h>

#include <numbers>

#include "tests/verification/fdem/contact_cases.hpp"
#include "tests/verification/fdem/two_bodies.hpp"

namespace fracfarm::verification {
namespace {

constexpr double h = 0.003, density = 2500.0, friction = 0.6;
constexpr double weight = 1e5;   // m/s^2, so that a run is short: 0.75 MPa under the block
constexpr double ramp = 100e-6;  // s, of the weight
const Material stone = cohesive(density, 20e9, 0.2, {friction, never, never, never, never});

struct Block {
  Run<double> run;
  int first, last;  // its triangles
  Drift drift() const { return drift_of(run, first, last); }
};

// A block of 8 x 1 squares on a table of 24 x 1 held below; pushed along by `push` weights from `from` on, growing within a ramp.
Block block_on_table(double velocity, double push, double from) {
  const TriangleMesh table = crossed_mesh(parts_of(0.0, 24 * h, 24), {-h, 0.0});
  const TriangleMesh block = crossed_mesh(parts_of(2.37 * h, 10.37 * h, 8), {0.0, h});
  fdem::Body body = two_bodies(table, block, stone);
  const int first = static_cast<int>(table.triangles.size()), last = static_cast<int>(body.mesh.triangles.size());
  for (const Axis axis : {Axis::x, Axis::z}) body.told.push_back(held(corners_where(body.mesh, at_z(-h)), axis));
  body.velocity.assign(3 * body.mesh.triangles.size(), {0.0, 0.0});
  for (int corner = 3 * first; corner < 3 * last; ++corner) body.velocity[static_cast<std::size_t>(corner)][0] = velocity;
  body.pulls.push_back(weight_on(body.mesh, density, {first, last}, {0.0, -weight}, [](double t) { return smooth_step(t / ramp); }));
  body.pulls.push_back(
      weight_on(body.mesh, density, {first, last}, {push * weight, 0.0}, [from](double t) { return smooth_step((t - from) / ramp); }));
  return {Run<double>(std::move(body), reference_settings(h)), first, last};
}

}  // namespace

std::vector<Row> sliding_block(Desk&) {
  // The weight's ramp takes mu g ramp / 2 of the velocity, and 3/20 mu g ramp^2 of the way.
  const double v = 25.0, slow = friction * weight, after = v - 0.5 * slow * ramp;
  const double way = v * ramp - 0.15 * slow * ramp * ramp + 0.5 * after * after / slow;
  std::vector<Row> rows;
  Block block = block_on_table(v, 0.0, 0.0);
  if (!block.run.start()) return rows;
  while (block.run.time() < 2.0 * ramp) block.run.step();
  const double early = block.drift().velocity[0], t0 = block.run.time();
  while (block.run.time() < ramp + 0.9 * after / slow) block.run.step();
  rows.push_back(
      compare("deceleration while it slides", "m/s2", slow, (early - block.drift().velocity[0]) / (block.run.time() - t0), 0.005));
  while (block.run.time() < ramp + 1.3 * after / slow) block.run.step();
  rows.push_back(compare("way to rest", "m", way, block.drift().displacement[0], 0.005, fmt::format("{:.2f} sides of triangles", way / h)));
  const SampleRow end = block.run.sample();
  const double given = 0.5 * block.drift().mass * v * v + end.external_work;
  rows.push_back(compare("heat of friction and viscosity over kinetic energy and work put in", "1", 1.0,
                         (end.friction_energy + end.viscous_energy) / given, 0.005,
                         fmt::format("viscosity {:.2g}", end.viscous_energy / given)));
  const double rest = block.drift().displacement[0];
  block.run.steps(2000);
  rows.push_back(
      compare("way after it has come to rest, over the way there", "1", 0.0, (block.drift().displacement[0] - rest) / way, 0.005));
  Block held_back = block_on_table(0.0, 0.95 * friction, 2.0 * ramp);
  if (!held_back.run.start()) return rows;
  while (held_back.run.time() < 3.5 * ramp) held_back.run.step();
  const double stuck = held_back.drift().displacement[0];
  held_back.run.steps(2000);
  rows.push_back(compare("pushed with 0.95 of what friction bears: creep", "m/s", 0.0,
                         (held_back.drift().displacement[0] - stuck) / (2000 * held_back.run.dt()), 0.005,
                         fmt::format("gave way by {:.2g} um", 1e6 * stuck)));
  Block pushed = block_on_table(0.0, 1.5 * friction, 2.0 * ramp);
  if (!pushed.run.start()) return rows;
  while (pushed.run.time() < 4.0 * ramp) pushed.run.step();
  const double v1 = pushed.drift().velocity[0], t1 = pushed.run.time();
  while (pushed.run.time() < 8.0 * ramp) pushed.run.step();
  rows.push_back(compare("pushed with 1.5 of it: acceleration", "m/s2", 0.5 * slow,
                         (pushed.drift().velocity[0] - v1) / (pushed.run.time() - t1), 0.005));
  return rows;
}

}  // namespace fracfarm::verification
