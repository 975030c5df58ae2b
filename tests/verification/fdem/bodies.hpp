// Specimens of the FDEM cases: regular meshes, materials, corners by place, and a body opened so that a case can read its state.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "solver/fdem/solver.hpp"

namespace fracfarm::verification {

inline constexpr double never = 1e15;  // strength (Pa) and toughness (J/m^2) that nothing reaches

// Isotropic, elastic: density (kg/m^3), Young's modulus (Pa), Poisson's ratio, and its joints.
Material cohesive(double density, double young, double poisson, const Cohesion& cohesion);
inline constexpr Cohesion unbreakable{0.0, never, never, never, never};
// As in the table, but that nothing breaks.
Material unbreakable_material(std::string_view name);

// Nodes at all x and z, and one in the middle of each rectangle, which is divided into four triangles around it.
TriangleMesh crossed_mesh(const std::vector<double>& x, const std::vector<double>& z);
// `count` equal parts.
std::vector<double> parts_of(double from, double to, int count);

// Edges between two triangles with both ends where `inside` (x, z) holds.
std::vector<int> edges_where(const TriangleMesh& mesh, const std::function<bool(double, double)>& inside);
// Corners at nodes where `inside` holds, of the triangles that have an edge there.
std::vector<fdem::Corner> corners_where(const TriangleMesh& mesh, const std::function<bool(double, double)>& inside);
inline auto at_z(double z) {
  return [z](double, double node_z) { return std::abs(node_z - z) < 1e-9; };
}
inline auto at_x(double x) {
  return [x](double node_x, double) { return std::abs(node_x - x) < 1e-9; };
}

// Velocity 0 along an axis.
fdem::Told held(std::vector<fdem::Corner> corners, Axis axis);
// A force (N/m) spread over the sides of triangles that lie where `inside` holds: `traction` in Pa.
fdem::Pull pull_on(const TriangleMesh& mesh, const std::function<bool(double, double)>& inside, std::array<double, 2> traction,
                   std::function<double(double)> share);

// A body while it runs.
template <class Real>
class Run {
 public:
  Run(fdem::Body body, const FdemSettings& settings, double dt_share = 0.7)
      : body_(body), fdem_(std::move(body), settings, Rules{}, 1), dt_(dt_share * fdem_.stable_dt()) {}

  void use_dt(double dt) { dt_ = dt; }
  bool start() { return fdem_.start(dt_).has_value(); }
  void step() { (void)fdem_.step(n_, dt_), ++n_; }
  void steps(long long count) {
    for (long long i = 0; i < count; ++i) step();
  }
  SampleRow sample() const { return fdem_.sample(n_, dt_); }
  double time() const { return static_cast<double>(n_) * dt_; }
  double dt() const { return dt_; }
  long long n() const { return n_; }
  const fdem::Fdem<Real>& fdem() const { return fdem_; }
  const fdem::Body& body() const { return body_; }

  double u(fdem::Corner corner, int axis) const { return fdem_.state().u[at(corner, axis)]; }
  double v(fdem::Corner corner, int axis) const { return fdem_.state().v[at(corner, axis)]; }
  double mass(fdem::Corner corner) const { return corner_mass(fdem_.plan(), fdem_.plan().corner_of(corner)); }
  int corners() const { return static_cast<int>(3 * body_.mesh.triangles.size()); }

 private:
  std::size_t at(fdem::Corner corner, int axis) const { return fdem::at_corner(fdem_.plan().corner_of(corner), axis); }

  fdem::Body body_;
  fdem::Fdem<Real> fdem_;
  double dt_;
  long long n_ = 0;
};

// Double, the paper's letter.
FdemSettings reference_settings(double element_size);

}  // namespace fracfarm::verification
