// The bilinear rectangle and its four quadrature points: the corners (Gauss-Lobatto) or Gauss 2 x 2. All elements are alike.
// Nodes and points in the order sw se nw ne; displacements of an element as ux uz of each node.
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/scene/scene.hpp"
#include "solver/law/elastic.hpp"

namespace fracfarm::phasefield::assembled {

using Strain = law::Strain<double>;
using ElementVector = Eigen::Matrix<double, 8, 1>;

struct Point {
  Eigen::Vector4d shape;               // of each node
  Eigen::Matrix<double, 2, 4> slope;   // d shape / dx, dz, 1/m
  Eigen::Matrix<double, 3, 8> strain;  // xx, zz, gamma of the displacements, 1/m
};

struct Element {
  std::array<Point, 4> points;
  double weight = 0.0;  // of a point, m^2
};

Element make_element(Quadrature quadrature, double hx, double hz);

}  // namespace fracfarm::phasefield::assembled
