#include "solver/phasefield/assembled/element.hpp"

#include <cmath>

namespace fracfarm::phasefield::assembled {
namespace {

// At (a, b) in [0, 1]^2 of the element.
Point point_at(double a, double b, double hx, double hz) {
  Point p;
  p.shape << (1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b;
  p.slope.row(0) << -(1.0 - b) / hx, (1.0 - b) / hx, -b / hx, b / hx;
  p.slope.row(1) << -(1.0 - a) / hz, -a / hz, (1.0 - a) / hz, a / hz;
  p.strain.setZero();
  for (int n = 0; n < 4; ++n) {
    p.strain(0, 2 * n) = p.strain(2, 2 * n + 1) = p.slope(0, n);
    p.strain(1, 2 * n + 1) = p.strain(2, 2 * n) = p.slope(1, n);
  }
  return p;
}

}  // namespace

Element make_element(Quadrature quadrature, double hx, double hz) {
  const double low = quadrature == Quadrature::gll ? 0.0 : 0.5 - 0.5 / std::sqrt(3.0), high = 1.0 - low;
  return {{point_at(low, low, hx, hz), point_at(high, low, hx, hz), point_at(low, high, hx, hz), point_at(high, high, hx, hz)},
          0.25 * hx * hz};
}

}  // namespace fracfarm::phasefield::assembled
