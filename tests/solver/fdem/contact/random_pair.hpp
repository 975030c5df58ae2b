// Random impacts of two rigid bodies.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/random.hpp"
#include "tests/solver/fdem/contact/bodies.hpp"

namespace fracfarm::fdem::testing {

inline constexpr double impact_size = 3e-3, impact_young = 30e9, impact_density = 2500.0;  // m, Pa, kg/m^3

// From the centre to the furthest corner.
inline double reach_of(const RigidScene<double>& scene, const RigidBody& body) {
  double furthest = 0.0;
  for (int t = body.first; t < body.first + body.count; ++t)
    for (int k = 0; k < 3; ++k)
      furthest = std::max(furthest, std::hypot(scene.triangles.x(t, k) - body.x0, scene.triangles.z(t, k) - body.z0));
  return furthest;
}

// Two blocks or triangles that fly at each other with random turn, offset and shape.
inline RigidScene<double> random_pair(RandomStream& random) {
  RigidScene<double> scene;
  for (int body = 0; body < 2; ++body) {
    if (random.uniform() < 0.3) {
      const double wide = impact_size * random.uniform(0.7, 1.5), high = impact_size * random.uniform(0.6, 1.5);
      scene.triangles.add({{{0.0, 0.0}, {wide, 0.0}, {wide * random.uniform(0.1, 0.9), high}}}, body);
    } else {
      const int nx = random.integer(1, 3), nz = random.integer(1, 3);
      add_block(scene.triangles, body, {0.0, 0.0}, {impact_size * nx, impact_size * nz}, {nx, nz});
    }
    scene.finish_body(impact_density);
  }
  for (RigidBody& body : scene.bodies) body.angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  RigidBody &a = scene.bodies[0], &b = scene.bodies[1];
  a.x = -a.x0, a.z = -a.z0;
  const double start = reach_of(scene, a) + reach_of(scene, b);
  const double away = random.uniform(0.0, 2.0 * std::numbers::pi), offset = 0.3 * start * random.uniform(-1.0, 1.0),
               speed = random.uniform(1.0, 10.0);
  b.x = -b.x0 + start * std::cos(away) - offset * std::sin(away), b.z = -b.z0 + start * std::sin(away) + offset * std::cos(away);
  b.vx = -speed * std::cos(away), b.vz = -speed * std::sin(away);
  a.turning = random.uniform(-300.0, 300.0);
  return scene;
}

struct Impact {
  double before = 0.0, after = 0.0, friction = 0.0, jumped = 0.0;
  bool met = false;
};

inline Impact impact(RigidScene<double> scene, double friction, double dt) {
  Contact<double> contact(scene.triangles.corners, scene.triangles.neighbour, {impact_young, friction, {}});
  scene.triangles.expose_boundary(contact);
  scene.place();
  Impact result;
  result.before = scene.kinetic();
  const double speed = std::hypot(scene.bodies[1].vx, scene.bodies[1].vz);
  const int steps = static_cast<int>(12.0 * impact_size / speed / dt);
  int apart = 0;
  for (int n = 0; n < steps && apart < 200; ++n) {
    scene.step(contact, dt);
    const bool touching = !contact.touches().empty();
    result.met = result.met || touching;
    apart = touching || !result.met ? 0 : apart + 1;
  }
  result.after = scene.kinetic();
  result.friction = contact.energies().friction, result.jumped = contact.energies().jumped;
  return result;
}

}  // namespace fracfarm::fdem::testing
