// Coulomb friction: a block on a table, level and inclined, and the spring's return mapping.
#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "tests/solver/fdem/contact/bodies.hpp"

using namespace fracfarm;
using namespace fracfarm::fdem;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double h = 3e-3, young = 30e9, density = 2500.0, friction = 0.6, weight = 1e5;  // weight: m/s^2, so that runs are short

// A block of 4 x 2 cells in balance on a fixed table of 24 cells.
RigidScene<double> block_on_table() {
  RigidScene<double> scene;
  add_block(scene.triangles, 0, {0.0, -h}, {24.0 * h, h}, {24, 1});
  scene.finish_body(density).fixed = true;
  add_block(scene.triangles, 1, {2.37 * h, 0.0}, {4.0 * h, 2.0 * h}, {4, 2});
  RigidBody& block = scene.finish_body(density);
  scene.gravity_z = -weight;
  scene.settling = 1e6;
  const double mean = h * std::sqrt(2.0 / std::sqrt(3.0));  // side of the equilateral triangle of area h^2 / 2
  block.z = block.mass * scene.gravity_z / (2.0 * young / mean * 4.0 * h);
  return scene;
}

struct Slide {
  double distance = 0.0, velocity = 0.0, dissipated = 0.0;
};

// Gravity leans to `slope`, rad, within `ramp`, s.
Slide slide_block(RigidScene<double> scene, double velocity, double seconds, double slope = 0.0, double ramp = 0.0) {
  Contact<double> contact(scene.triangles.corners, scene.triangles.neighbour, {young, friction, {}});
  scene.triangles.expose_boundary(contact);
  RigidBody& block = scene.bodies[1];
  block.vx = velocity;
  const double dt = 1e-7;
  for (int n = 0; n * dt < seconds; ++n) {
    const double lean = n * dt < ramp ? slope * n * dt / ramp : slope;
    scene.gravity_x = weight * std::sin(lean), scene.gravity_z = -weight * std::cos(lean);
    scene.step(contact, dt);
  }
  return {block.x, block.vx, contact.energies().friction};
}

}  // namespace

TEST_CASE("A sliding block slows by mu g, comes to rest after v^2 / (2 mu g) and stays there") {
  const double v = 20.0, stop = v / (friction * weight), way = 0.5 * v * stop;
  const RigidScene<double> scene = block_on_table();
  const Slide half = slide_block(scene, v, 0.5 * stop), rest = slide_block(scene, v, 1.5 * stop);
  CHECK(half.velocity == Approx(0.5 * v).epsilon(0.005));
  CHECK(rest.distance == Approx(way).epsilon(0.005));
  CHECK(rest.distance > h);
  CHECK(std::abs(rest.velocity) < 0.005 * v);
  CHECK(rest.dissipated == Approx(0.5 * scene.bodies[1].mass * v * v).epsilon(0.005));
}

TEST_CASE("A block rests on a slope below the angle of friction and slides with g (sin - mu cos) above") {
  const Slide rest = slide_block(block_on_table(), 0.0, 3e-4, 0.95 * std::atan(friction), 1e-4);
  CHECK(std::abs(rest.distance) < 1e-6);  // the springs' give
  CHECK(std::abs(rest.velocity) < 1e-2);
  const double steep = 1.2 * std::atan(friction), a = weight * (std::sin(steep) - friction * std::cos(steep)), t = 5e-4;
  const Slide early = slide_block(block_on_table(), 0.0, t, steep, 1e-5), late = slide_block(block_on_table(), 0.0, 2.0 * t, steep, 1e-5);
  CHECK(late.velocity - early.velocity == Approx(a * t).epsilon(0.005));
}

TEST_CASE("The friction spring never gives more than was put in, whatever its limit does meanwhile") {
  RandomStream random(11, 1, 1);
  for (int run = 0; run < 200; ++run) {
    Touch touch;
    touch.stiffness = 1e10;
    double work = 0.0, lost = 0.0;
    for (int n = 0; n < 200; ++n) {
      touch.overlap = std::max(0.0, touch.overlap + 1e-7 * random.uniform(-1.0, 1.0));
      const double moved = 1e-7 * random.uniform(-1.0, 1.0), last = touch.slip;
      lost += slide(touch, friction, moved);
      CHECK(std::abs(touch.slip) <= friction * touch.overlap);
      work += 0.5 * touch.stiffness * (last + touch.slip) * moved;
    }
    CHECK(lost > 0.0);
    CHECK(work == Approx(lost + 0.5 * touch.stiffness * touch.slip * touch.slip).epsilon(1e-9));
  }
}
