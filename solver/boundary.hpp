// Boundary conditions: which degrees of freedom move as told, which nodes carry a traction, and how both grow in time.
// A solver gives its nodes along each side and keeps the lists; nothing here knows a grid or a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/scene/scene.hpp"

namespace fracfarm {

enum class Axis { x, z };

// One node of a side: its index in the solver's fields, its place along the side, and the stretch of the side that it stands for (m).
struct SideNode {
  std::size_t index = 0;
  double at = 0.0;
  double from = 0.0;
  double to = 0.0;
};
using SideNodes = std::array<std::vector<SideNode>, 4>;  // by Side

// Nodes whose velocity along one axis is given.
struct Motion {
  Side side = Side::top;
  Axis axis = Axis::z;
  bool normal = true;     // across its side; else along it
  double velocity = 0.0;  // m/s along +axis, after the ramp
  double ramp = 0.0;      // s
  std::vector<std::size_t> nodes;
  double at(double time) const;
};

// Forces on nodes, N/m after the ramp.
struct Traction {
  double ramp = 0.0;  // s
  std::vector<std::size_t> nodes;
  std::vector<double> fx, fz;
  double share(double time) const;  // 0...1
};

struct Boundary {
  std::vector<Motion> motions;
  std::vector<Traction> tractions;
};

// Linear from 0 at t = 0 to 1 at `ramp`; a step where the ramp is 0.
double ramp_share(double time, double ramp);

// A degree of freedom is told once: normal velocities before tangential ones, then sides in the order left, right, bottom, top and parts in
// the order of the scene. Tractions act on the nodes of their part, each on the stretch that lies inside it.
Boundary build_boundary(const Scene& scene, const SideNodes& nodes);

// True where the scene moves or pulls on the side.
bool is_loaded(const Scene& scene, Side side);

}  // namespace fracfarm
