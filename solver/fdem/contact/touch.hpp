// One point of a side inside another body: what is remembered of it from step to step, and its forces. Pointwise, no lists.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/fdem/contact/overlap.hpp"

namespace fracfarm::fdem {

// K (overlap, slip) are the normal and tangential force.
struct Touch {
  int target = 0, side = 0, point = 0;  // places of both sides, Gauss point on the target
  double overlap = 0.0;                 // d - d0, m
  double origin = 0.0;                  // d0, m
  double slip = 0.0;                    // of the friction spring, m
  double stiffness = 0.0;               // K, N/m per metre of thickness
  bool carried_on = false;              // by a touch of the next step

  double stored() const { return 0.5 * stiffness * (overlap * overlap + slip * slip); }
};

// Where the touch is now: depth d, share xi of the way along the side, and the side's axes.
struct TouchPlace {
  double depth, share;
  Axes axes;
};

// A vector at each end of a side: displacements, or forces.
struct Ends {
  double ax, az, bx, bz;
};

inline Ends difference(const SideNow& now, const SideNow& then) {
  return {now.ax - then.ax, now.az - then.az, now.bx - then.bx, now.bz - then.bz};
}

// Motion of the point against the material of the other body at the same place, m: along the side and into it. The other body turns as its
// side does: it moves at the point as at the point's foot on the side, and by the side's turn times the depth.
struct RelativeMotion {
  double along, into;
  double length() const { return std::sqrt(along * along + into * into); }
};

inline RelativeMotion relative_motion(const TouchPlace& at, double place, const Ends& target, const Ends& side) {
  const double tx = at.axes.tx, tz = at.axes.tz, share = at.share;
  const double x = target.ax + place * (target.bx - target.ax) - side.ax - share * (side.bx - side.ax);
  const double z = target.az + place * (target.bz - target.az) - side.az - share * (side.bz - side.az);
  const double turn = (tx * (side.bz - side.az) - tz * (side.bx - side.ax)) / at.axes.length;
  return {tx * x + tz * z + turn * at.depth, tx * z - tz * x};
}

// Return mapping of the spring under |slip| <= mu overlap: first the limit of now, then the motion of the step. Gives the energy lost, J/m:
// the step's work by the mean of both forces, which is what a leapfrog does, less what the spring holds more.
inline double slide(Touch& touch, double friction, double moved) {
  const double limit = friction * touch.overlap, last = touch.slip;
  touch.slip = std::clamp(std::clamp(last, -limit, limit) + moved, -limit, limit);
  return 0.5 * touch.stiffness * (last + touch.slip) * (moved - (touch.slip - last));
}

// Forces on the ends of target and side, N/m.
struct EndForces {
  Ends target, side;
};

// -dU/du for the normal part; the tangential part acts at the point on both bodies: on the side's ends through its foot and a couple.
inline EndForces end_forces(const Touch& touch, const TouchPlace& at, double place) {
  const double normal = touch.stiffness * touch.overlap, along = -touch.stiffness * touch.slip;  // on the target, outwards and along
  const double tx = at.axes.tx, tz = at.axes.tz;
  const double fx = normal * tz + along * tx, fz = -normal * tx + along * tz;
  const double couple = along * at.depth / at.axes.length, cx = -tz * couple, cz = tx * couple;
  EndForces f;
  f.target = {(1.0 - place) * fx, (1.0 - place) * fz, place * fx, place * fz};
  f.side = {-(1.0 - at.share) * fx - cx, -(1.0 - at.share) * fz - cz, -at.share * fx + cx, -at.share * fz + cz};
  return f;
}

}  // namespace fracfarm::fdem
