// Nodes of a bench whose displacement is given as a field of place and time, and the field around a mode I crack tip.
#pragma once

#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/verification/bench.hpp"

namespace fracfarm::verification {

class HeldNodes {
 public:
  template <class Which>  // (x, z) -> bool
  HeldNodes(Bench& bench, Which which) : bench_(bench) {
    const phasefield::Grid& grid = bench.model.grid;
    for (int j = 0; j < grid.rows; ++j)
      for (int i = 0; i < grid.columns; ++i) {
        const double x = i * grid.hx, z = j * grid.hz;
        if (!which(x, z)) continue;
        nodes_.push_back({bench.at(i, j), x, z, 0.0, 0.0});
        bench.model.inverse_mass_x[nodes_.back().index] = bench.model.inverse_mass_z[nodes_.back().index] = 0.0;
      }
    bench.remake();
  }

  template <class Displacement>  // (x, z) -> {ux, uz}
  void shape(Displacement displacement) {
    for (Node& node : nodes_) std::tie(node.ux, node.uz) = displacement(node.x, node.z);
  }
  // Velocities that take the held nodes to `scale` times the shape in one step of dt.
  void aim(double scale, double dt) {
    phasefield::State<double>& state = bench_.state;
    for (const Node& node : nodes_) {
      state.vx[node.index] = (scale * node.ux - state.ux[node.index]) / dt;
      state.vz[node.index] = (scale * node.uz - state.uz[node.index]) / dt;
    }
  }

 private:
  struct Node {
    std::size_t index;
    double x, z, ux, uz;
  };
  Bench& bench_;
  std::vector<Node> nodes_;
};

// Plane strain: displacement per stress intensity (m per Pa sqrt(m)) around a tip at the origin whose crack lies along -x
// (Williams, 1957).
struct NearTip {
  double young, poisson;
  double modulus() const { return young / (1.0 - poisson * poisson); }            // E': G = K^2 / E'
  std::pair<double, double> at(double x, double z, bool sliding = false) const {  // mode I, or mode II
    const double r = std::hypot(x, z), half = 0.5 * std::atan2(z, x), kappa = 3.0 - 4.0 * poisson, mu = 0.5 * young / (1.0 + poisson);
    const double scale = std::sqrt(r / (2.0 * std::numbers::pi)) / (2.0 * mu), s = std::sin(half), c = std::cos(half);
    if (sliding) return {scale * s * (kappa + 1.0 + 2.0 * c * c), -scale * c * (kappa - 1.0 - 2.0 * s * s)};
    return {scale * c * (kappa - 1.0 + 2.0 * s * s), scale * s * (kappa + 1.0 - 2.0 * c * c)};
  }
  // The same with the crack's direction of growth turned by `angle` from x.
  std::pair<double, double> turned(double angle, double x, double z, bool sliding) const {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto [along, across] = at(c * x + s * z, c * z - s * x, sliding);
    return {c * along - s * across, s * along + c * across};
  }
};

}  // namespace fracfarm::verification
