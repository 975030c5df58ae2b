// Rigid bodies made of triangles, in leapfrog: the smallest thing that contact can act between.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "solver/fdem/contact/contact.hpp"

namespace fracfarm::fdem::testing {

// Triangles as Contact wants them, in `Real`, and the sides that lie across from each other within a body.
template <class Real>
struct Triangles {
  CornerRows corners;
  std::vector<TriangleSide> neighbour;
  std::vector<Real> displacement, force;

  int count() const { return static_cast<int>(corners.size() / 8); }
  // Corners as x z pairs, counter-clockwise. `body` tells apart bodies that share points.
  void add(const std::array<std::array<double, 2>, 3>& points, int body) {
    const int t = count();
    for (const std::size_t k : {0, 1, 2, 0}) corners.insert(corners.end(), points[k].begin(), points[k].end());
    for (std::size_t k = 0; k < 3; ++k) {
      neighbour.push_back(-1);
      const int side = 3 * t + static_cast<int>(k);
      const auto other = sides_.find({body, points[(k + 1) % 3], points[k]});
      sides_[{body, points[k], points[(k + 1) % 3]}] = side;
      if (other == sides_.end()) continue;
      neighbour[static_cast<std::size_t>(side)] = other->second;
      neighbour[static_cast<std::size_t>(other->second)] = side;
    }
    for (std::vector<Real>* rows : {&displacement, &force}) rows->resize(corners.size(), Real(0));
  }
  double x(int t, int k) const { return corners[at(t, k)] + static_cast<double>(displacement[at(t, k)]); }
  double z(int t, int k) const { return corners[at(t, k) + 1] + static_cast<double>(displacement[at(t, k) + 1]); }
  static std::size_t at(int t, int k) { return 8 * static_cast<std::size_t>(t) + 2 * static_cast<std::size_t>(k); }
  // Columns 6 and 7 repeat corner 0.
  void move(int t, int k, double dx, double dz) {
    displacement[at(t, k)] += static_cast<Real>(dx), displacement[at(t, k) + 1] += static_cast<Real>(dz);
    if (k == 0) displacement[at(t, 3)] = displacement[at(t, 0)], displacement[at(t, 3) + 1] = displacement[at(t, 0) + 1];
  }
  void expose_boundary(Contact<Real>& contact) const {
    for (std::size_t s = 0; s < neighbour.size(); ++s)
      if (neighbour[s] < 0) contact.expose(static_cast<TriangleSide>(s));
  }

 private:
  std::map<std::tuple<int, std::array<double, 2>, std::array<double, 2>>, int> sides_;
};

// A rectangle of nx * nz cells of two triangles each; which diagonal alternates.
template <class Real>
void add_block(Triangles<Real>& to, int body, std::array<double, 2> low, std::array<double, 2> size, std::array<int, 2> cells) {
  const auto point = [&](int i, int j) -> std::array<double, 2> {
    return {low[0] + size[0] * i / cells[0], low[1] + size[1] * j / cells[1]};
  };
  for (int j = 0; j < cells[1]; ++j)
    for (int i = 0; i < cells[0]; ++i) {
      const auto a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
      if ((i + j) % 2 == 0) {
        to.add({a, b, c}, body);
        to.add({a, c, d}, body);
      } else {
        to.add({a, b, d}, body);
        to.add({b, c, d}, body);
      }
    }
}

struct RigidBody {
  int first = 0, count = 0;  // triangles
  double mass = 0.0, inertia = 0.0, x0 = 0.0, z0 = 0.0;
  double x = 0.0, z = 0.0, angle = 0.0;      // displacement of the centre, turn
  double vx = 0.0, vz = 0.0, turning = 0.0;  // half a step behind in the loop
  bool fixed = false;
  double kinetic() const { return 0.5 * mass * (vx * vx + vz * vz) + 0.5 * inertia * turning * turning; }
};

template <class Real = double>
struct RigidScene {
  Triangles<Real> triangles;
  std::vector<RigidBody> bodies;
  double gravity_x = 0.0, gravity_z = 0.0;  // m/s^2
  double settling = 0.0;                    // 1/s, damps v_z and turning, so that a block soon lies still on a level table

  // The triangles added since the last body; density in kg/m^3.
  RigidBody& finish_body(double density) {
    RigidBody body;
    body.first = bodies.empty() ? 0 : bodies.back().first + bodies.back().count;
    body.count = triangles.count() - body.first;
    double moment = 0.0;  // about the origin
    for (int t = body.first; t < triangles.count(); ++t) {
      const double ax = triangles.x(t, 0), az = triangles.z(t, 0), bx = triangles.x(t, 1), bz = triangles.z(t, 1), cx = triangles.x(t, 2),
                   cz = triangles.z(t, 2);
      const double m = 0.5 * density * ((bx - ax) * (cz - az) - (bz - az) * (cx - ax));
      body.mass += m, body.x0 += m * (ax + bx + cx) / 3.0, body.z0 += m * (az + bz + cz) / 3.0;
      const double sx = ax + bx + cx, sz = az + bz + cz;
      moment += m / 12.0 * (ax * ax + bx * bx + cx * cx + sx * sx + az * az + bz * bz + cz * cz + sz * sz);
    }
    body.x0 /= body.mass, body.z0 /= body.mass;
    body.inertia = moment - body.mass * (body.x0 * body.x0 + body.z0 * body.z0);
    bodies.push_back(body);
    return bodies.back();
  }
  double kinetic() const {
    double sum = 0.0;
    for (const RigidBody& body : bodies) sum += body.fixed ? 0.0 : body.kinetic();
    return sum;
  }
  // Displacement rows of where the bodies are.
  void place() {
    for (const RigidBody& body : bodies)
      for (int t = body.first; t < body.first + body.count; ++t)
        for (int k = 0; k < 4; ++k) {
          const std::size_t n = Triangles<Real>::at(t, k);
          const double rx = triangles.corners[n] - body.x0, rz = triangles.corners[n + 1] - body.z0;
          const double c = std::cos(body.angle) - 1.0, s = std::sin(body.angle);
          triangles.displacement[n] = static_cast<Real>(body.x + c * rx - s * rz);
          triangles.displacement[n + 1] = static_cast<Real>(body.z + s * rx + c * rz);
        }
  }
  // Drift, contact, kick.
  void step(Contact<Real>& contact, double dt) {
    for (RigidBody& body : bodies) body.x += dt * body.vx, body.z += dt * body.vz, body.angle += dt * body.turning;
    place();
    std::fill(triangles.force.begin(), triangles.force.end(), Real(0));
    contact.add_forces(triangles.displacement.data(), triangles.force.data());
    for (RigidBody& body : bodies)
      if (!body.fixed) kick(body, dt);
  }

 private:
  void kick(RigidBody& body, double dt) {
    double fx = body.mass * gravity_x, fz = body.mass * gravity_z, moment = 0.0;
    for (int t = body.first; t < body.first + body.count; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::size_t n = Triangles<Real>::at(t, k);
        const double gx = static_cast<double>(triangles.force[n]), gz = static_cast<double>(triangles.force[n + 1]);
        fx += gx, fz += gz;
        moment += (triangles.x(t, k) - body.x0 - body.x) * gz - (triangles.z(t, k) - body.z0 - body.z) * gx;
      }
    body.vz *= 1.0 - settling * dt, body.turning *= 1.0 - settling * dt;
    body.vx += dt * fx / body.mass, body.vz += dt * fz / body.mass, body.turning += dt * moment / body.inertia;
  }
};

}  // namespace fracfarm::fdem::testing
