// An edge between two triangles as its joint sees it: how far it is open at both ends, the line midway between its sides, and its two Gauss
// points. Openings are of the right triangle against the left one.
#pragma once

#include "solver/law/joint.hpp"

namespace fracfarm::law {

template <class Real>
struct Vector {
  Real x, z;
};

// At both ends of an edge; of a triangle's own edge from its first corner to its second.
template <class Real>
struct Ends {
  Real ax, az, bx, bz;
};

// From the first node to the second, m; and the square of its length.
template <class Real>
struct Line {
  Real x, z, square;
};

// From displacements: the left triangle goes from a to b, the right one from b to a.
template <class Real>
FRACFARM_POINTWISE Ends<Real> opening_between(const Ends<Real>& left, const Ends<Real>& right) {
  return {right.bx - left.ax, right.bz - left.az, right.ax - left.bx, right.az - left.bz};
}

template <class Real>
FRACFARM_POINTWISE Line<Real> midline(const Vector<Real>& undeformed, const Ends<Real>& left, const Ends<Real>& right) {
  const Real half(0.5);
  const Real x = undeformed.x + half * ((left.bx - left.ax) + (right.ax - right.bx));
  const Real z = undeformed.z + half * ((left.bz - left.az) + (right.az - right.bz));
  return {x, z, x * x + z * z};
}

// Weights of the nearer and the farther end at a Gauss point.
inline constexpr double near = 0.5 + 0.28867513459481287, far = 0.5 - 0.28867513459481287;

template <class Real>
FRACFARM_POINTWISE Vector<Real> near_a(const Ends<Real>& e) {
  return {Real(near) * e.ax + Real(far) * e.bx, Real(near) * e.az + Real(far) * e.bz};
}
template <class Real>
FRACFARM_POINTWISE Vector<Real> near_b(const Ends<Real>& e) {
  return {Real(far) * e.ax + Real(near) * e.bx, Real(far) * e.az + Real(near) * e.bz};
}

// Across and along the line, times its length: nothing need be made a unit vector.
template <class Real>
FRACFARM_POINTWISE Opening<Real> parts_of(const Vector<Real>& v, const Line<Real>& line) {
  return {v.x * line.z - v.z * line.x, v.x * line.x + v.z * line.z};
}

// The larger lambda^2 of both points, times the square of the line's length; and whether that lambda is above 1.
template <class Real>
FRACFARM_POINTWISE Real largest_stretch(const Joint<Real>& law, const Ends<Real>& opening, const Line<Real>& line) {
  return larger(extent(law, parts_of(near_a(opening), line)).onset, extent(law, parts_of(near_b(opening), line)).onset);
}
template <class Real>
FRACFARM_POINTWISE auto overstretched(const Joint<Real>& law, const Ends<Real>& opening, const Line<Real>& line) {
  return largest_stretch(law, opening, line) > line.square;
}

}  // namespace fracfarm::law
