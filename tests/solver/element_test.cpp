#include "solver/phasefield/assembled/element.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm;
using namespace fracfarm::phasefield::assembled;

namespace {

Eigen::Matrix4d mass_of(const Element& element) {
  Eigen::Matrix4d mass = Eigen::Matrix4d::Zero();
  for (const Point& point : element.points) mass += element.weight * point.shape * point.shape.transpose();
  return mass;
}

}  // namespace

TEST_CASE("Gauss points integrate products of the shapes exactly, corner points lump them") {
  const double hx = 0.3, hz = 0.2, area = hx * hz;
  Eigen::Matrix4d exact;
  exact << 4, 2, 2, 1, 2, 4, 1, 2, 2, 1, 4, 2, 1, 2, 2, 4;
  CHECK((mass_of(make_element(Quadrature::gauss, hx, hz)) - area / 36.0 * exact).norm() < 1e-15);
  CHECK((mass_of(make_element(Quadrature::gll, hx, hz)) - 0.25 * area * Eigen::Matrix4d::Identity()).norm() < 1e-15);
}

TEST_CASE("either quadrature gives a uniform strain its strain at every point") {
  const double hx = 0.3, hz = 0.2, xx = 1e-3, zz = -2e-3, xz = 3e-3;
  ElementVector u;
  const double x[4] = {0, hx, 0, hx}, z[4] = {0, 0, hz, hz};
  for (int n = 0; n < 4; ++n) u[2 * n] = xx * x[n] + 0.4 * xz * z[n], u[2 * n + 1] = zz * z[n] + 0.6 * xz * x[n];
  for (const Quadrature quadrature : {Quadrature::gll, Quadrature::gauss})
    for (const Point& point : make_element(quadrature, hx, hz).points)
      CHECK((point.strain * u - Eigen::Vector3d(xx, zz, xz)).norm() < 1e-17);
}
