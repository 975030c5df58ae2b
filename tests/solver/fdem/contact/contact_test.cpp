// The forces of one step: potential, balance, and where there must be none.
#include "solver/fdem/contact/contact.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "common/base/random.hpp"
#include "tests/solver/fdem/contact/bodies.hpp"

using namespace fracfarm;
using namespace fracfarm::fdem;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double h = 3e-3, young = 30e9;

// Two blocks of 3 x 2 cells, the upper a depth inside the lower and shifted.
Triangles<double> stacked(double depth, double shift) {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {3.0 * h, 2.0 * h}, {3, 2});
  add_block(triangles, 1, {shift, 2.0 * h - depth}, {3.0 * h, 2.0 * h}, {3, 2});
  return triangles;
}

// One step from before the bodies met to where they are, so that the whole depth counts: the upper body comes down by `fall` and to the
// right by `drag`.
struct Meeting {
  double stored = 0.0;
  std::vector<double> force;
};

Meeting meet(const Triangles<double>& triangles, double friction = 0.0, double drag = 0.0) {
  constexpr double fall = 1e-3;
  Contact<double> contact(triangles.corners, triangles.neighbour, {young, friction, {}});
  triangles.expose_boundary(contact);
  Triangles<double> before = triangles;
  for (int t = 12; t < triangles.count(); ++t)
    for (int k = 0; k < 3; ++k) before.move(t, k, -drag, fall);
  Meeting result;
  result.force.assign(triangles.corners.size(), 0.0);
  contact.add_forces(before.displacement.data(), result.force.data());
  contact.add_forces(triangles.displacement.data(), result.force.data());
  result.stored = contact.energies().stored;
  return result;
}

double energy_of(const Triangles<double>& triangles) { return meet(triangles).stored; }
std::vector<double> forces_of(const Triangles<double>& triangles, double friction = 0.0, double drag = 0.0) {
  return meet(triangles, friction, drag).force;
}

void shake(Triangles<double>& triangles, double by, std::uint64_t id) {
  RandomStream random(3, id, 1);
  for (int t = 0; t < triangles.count(); ++t)
    for (int k = 0; k < 3; ++k) triangles.move(t, k, random.uniform(-by, by), random.uniform(-by, by));
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

TEST_CASE("A block pressed evenly into another stores K d^2 of both faces and is pushed back by 2 penalty / h times the overlap") {
  const double depth = 2e-6;
  Triangles<double> triangles = stacked(depth, 0.0);
  const std::vector<double> force = forces_of(triangles);
  double up = 0.0;
  for (int t = 12; t < triangles.count(); ++t)
    for (int k = 0; k < 3; ++k) up += force[Triangles<double>::at(t, k) + 1];
  const Contact<double> contact(triangles.corners, triangles.neighbour, {young, 0.0, {}});
  const double stiffness = young / contact.surface().mean_length() * 3.0 * h;
  CHECK(up == Approx(2.0 * stiffness * depth).epsilon(1e-9));
  CHECK(energy_of(triangles) == Approx(stiffness * depth * depth).epsilon(1e-9));
}

TEST_CASE("Contact forces add up to no force and no moment, with friction too") {
  for (std::uint64_t id = 0; id < 50; ++id) {
    Triangles<double> triangles = stacked(20e-6, 0.37 * h);
    shake(triangles, 10e-6, id);
    const std::vector<double> force = forces_of(triangles, 0.6, 3e-6);
    double fx = 0.0, fz = 0.0, moment = 0.0, lever = 0.0;
    for (int t = 0; t < triangles.count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::size_t n = Triangles<double>::at(t, k);
        fx += force[n], fz += force[n + 1];
        moment += triangles.x(t, k) * force[n + 1] - triangles.z(t, k) * force[n];
        lever += std::hypot(force[n], force[n + 1]) * h;
      }
    REQUIRE(largest(force) > 100.0);
    CHECK(std::abs(fx) < 1e-12 * largest(force));
    CHECK(std::abs(fz) < 1e-12 * largest(force));
    CHECK(std::abs(moment) < 1e-12 * lever);
  }
}

TEST_CASE("Without friction, forces are minus the gradient of the stored energy, corner by corner") {
  for (std::uint64_t id = 0; id < 4; ++id) {
    Triangles<double> triangles = stacked(20e-6, 0.37 * h);
    shake(triangles, 5e-6, id);
    const std::vector<double> force = forces_of(triangles);
    const double scale = largest(force), step = 1e-9;
    int pushed = 0;
    for (int t = 0; t < triangles.count(); ++t)
      for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 2; ++axis) {
          Triangles<double> plus = triangles, minus = triangles;
          plus.move(t, k, axis == 0 ? step : 0.0, axis == 1 ? step : 0.0);
          minus.move(t, k, axis == 0 ? -step : 0.0, axis == 1 ? -step : 0.0);
          const double slope = (energy_of(plus) - energy_of(minus)) / (2.0 * step);
          const double expected = -force[Triangles<double>::at(t, k) + static_cast<std::size_t>(axis)];
          CHECK(std::abs(slope - expected) < 1e-6 * scale);
          pushed += expected != 0.0;
        }
    CHECK(pushed > 20);
  }
}

TEST_CASE("Nothing is pushed without an overlap") {
  Triangles<double> triangles = stacked(-1e-9, 0.37 * h);
  CHECK(largest(forces_of(triangles)) == 0.0);
  CHECK(energy_of(triangles) == 0.0);
}

TEST_CASE("Sides of one body do not push each other, neither at its corners nor at a closed crack whose faces are apart") {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {4.0 * h, 4.0 * h}, {4, 4});
  Contact<double> contact(triangles.corners, triangles.neighbour, {young, 0.6, {}});
  triangles.expose_boundary(contact);
  for (std::size_t side = 0; side < triangles.neighbour.size(); ++side)  // the lower half of the horizontal middle line
    if (const int other = triangles.neighbour[side]; other >= 0) {
      const int t = static_cast<int>(side) / 3, k = static_cast<int>(side) % 3;
      if (triangles.z(t, k) == 2.0 * h && triangles.z(t, (k + 1) % 3) == 2.0 * h && triangles.x(t, k) <= 2.0 * h &&
          triangles.x(t, (k + 1) % 3) <= 2.0 * h)
        contact.expose(static_cast<int>(side));
    }
  std::vector<double> force(triangles.corners.size(), 0.0);
  contact.add_forces(triangles.displacement.data(), force.data());
  CHECK(contact.surface().sides().size() == 16 + 4);
  CHECK(largest(force) < 1e-3);                // rounding of the coordinates, 1e-18 m
  for (int t = 0; t < triangles.count(); ++t)  // opened by 1 um
    for (int k = 0; k < 3; ++k)
      if (t >= 16 && triangles.x(t, k) < 2.0 * h) triangles.move(t, k, 0.0, 1e-6);
  std::fill(force.begin(), force.end(), 0.0);
  contact.add_forces(triangles.displacement.data(), force.data());
  CHECK(largest(force) == 0.0);
}

// Two triangles over a horizontal edge, the upper pressed 1 um into the lower.
Triangles<double> pressed_edge() {
  Triangles<double> triangles;
  triangles.add({{{0.0, 0.0}, {h, 0.0}, {0.5 * h, 0.9 * h}}}, 0);
  triangles.add({{{h, 0.0}, {0.0, 0.0}, {0.5 * h, -0.9 * h}}}, 0);
  for (int k = 0; k < 3; ++k) triangles.move(0, k, 0.0, -1e-6);
  return triangles;
}

TEST_CASE("An edge that breaks while pressed together keeps its overlap, and the energy is booked as a jump") {
  const Triangles<double> triangles = pressed_edge();
  Contact<double> contact(triangles.corners, triangles.neighbour, {young, 0.0, {}});
  contact.expose(0);
  contact.expose(triangles.neighbour[0]);
  std::vector<double> force(triangles.corners.size(), 0.0);
  contact.add_forces(triangles.displacement.data(), force.data());
  const double stiffness = young / contact.surface().mean_length();
  CHECK(force[1] + force[3] == Approx(2.0 * stiffness * h * 1e-6).epsilon(1e-6));
  CHECK(contact.energies().jumped == Approx(stiffness * h * 1e-12).epsilon(1e-6));
  CHECK(contact.energies().stored == contact.energies().jumped);
}

TEST_CASE("A crack that is exposed while its faces overlap forgets the overlap") {
  Triangles<double> triangles = pressed_edge();
  Contact<double> contact(triangles.corners, triangles.neighbour, {young, 0.0, {}});
  contact.expose(0, false);
  contact.expose(triangles.neighbour[0], false);
  std::vector<double> force(triangles.corners.size(), 0.0);
  contact.add_forces(triangles.displacement.data(), force.data());
  CHECK(largest(force) == 0.0);
  for (int k = 0; k < 3; ++k) triangles.move(0, k, 0.0, -1e-6);
  contact.add_forces(triangles.displacement.data(), force.data());
  CHECK(force[1] + force[3] == Approx(2.0 * young / contact.surface().mean_length() * h * 1e-6).epsilon(1e-6));
  CHECK(contact.energies().jumped == 0.0);
}

TEST_CASE("Rows that are pads change nothing") {
  Triangles<double> triangles = pressed_edge();
  const double length = Surface(triangles.corners, triangles.neighbour).mean_length();
  triangles.corners.resize(triangles.corners.size() + 16, 0.0);
  triangles.neighbour.resize(triangles.neighbour.size() + 6, -1);
  CHECK(Surface(triangles.corners, triangles.neighbour).mean_length() == length);
}

TEST_CASE("A side that is exposed while something else already lies inside pushes nothing until that has left and come back") {
  Triangles<double> triangles = stacked(50e-6, 0.37 * h);  // nothing moves: the overlap was not come by
  Contact<double> contact(triangles.corners, triangles.neighbour, {young, 0.6, {}});
  triangles.expose_boundary(contact);
  std::vector<double> force(triangles.corners.size(), 0.0);
  contact.add_forces(triangles.displacement.data(), force.data());
  CHECK(largest(force) == 0.0);
  CHECK(!contact.touches().empty());
  const auto move_upper = [&](double by) {
    for (int t = 12; t < triangles.count(); ++t)
      for (int k = 0; k < 3; ++k) triangles.move(t, k, 0.0, by);
    std::fill(force.begin(), force.end(), 0.0);
    contact.add_forces(triangles.displacement.data(), force.data());
  };
  move_upper(-1e-6);
  const double pressed = largest(force);
  CHECK(pressed > 0.0);
  move_upper(31e-6);
  CHECK(largest(force) == 0.0);
  move_upper(-1e-6);  // the zero has gone along
  CHECK(largest(force) == Approx(pressed).epsilon(1e-6));
}

TEST_CASE("Coordinates that are no numbers, huge or collapsed push nobody and end no step") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, 1e30, 1e6}) {
    Triangles<double> triangles = stacked(20e-6, 0.37 * h);
    const std::vector<double> sane = forces_of(triangles);
    triangles.move(23, 2, bad, -bad);
    triangles.move(1, 1, bad, bad);
    const std::vector<double> force = forces_of(triangles);
    for (const double f : force) CHECK(std::abs(f) <= 2.0 * largest(sane));
    for (int t = 0; t < triangles.count(); ++t)
      for (int k = 0; k < 3; ++k) triangles.move(t, k, bad, bad);
    CHECK(forces_of(triangles).size() == force.size());
  }
}
