// What FDEM moves: a mesh with its materials, and what is done to its corners. A scene becomes one (scene_body.cpp); specimens that are no
// rectangles are written down as one.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "common/material/material.hpp"
#include "common/scene/triangle_mesh.hpp"
#include "solver/boundary.hpp"

namespace fracfarm::fdem {

// Corner k of triangle t of the mesh, as 3 t + k. Every triangle owns its corners: those that meet at a node may part.
using Corner = int;

// Corners whose velocity along one axis is given.
struct Told {
  std::vector<Corner> corners;
  Axis axis = Axis::z;
  std::function<double(double)> velocity;  // m/s at a time in s, which may be half a step before 0
  std::optional<Side> side;                // whose reaction the force on them is
};

// Forces on corners, N/m, growing together.
struct Pull {
  std::vector<Corner> corners;
  std::vector<std::array<double, 2>> force;
  std::function<double(double)> share;  // at a time in s
};

struct Body {
  TriangleMesh mesh;
  std::vector<Material> materials;                  // with cohesion
  std::vector<int> material_of;                     // by triangle; empty: the first
  std::vector<unsigned char> asleep;                // by edge: 1 ties both sides together and never opens; empty: none
  std::vector<std::array<double, 2>> displacement;  // at t = 0, by corner, m; empty: none
  std::vector<std::array<double, 2>> velocity;      // at t = 0, by corner, m/s; empty: at rest
  std::vector<Corner> exposed;                      // sides (edge k of triangle t, as 3 t + k) that may be touched from the start
  std::vector<Told> told;                           // a corner's axis is told once
  std::vector<Pull> pulls;
  std::array<double, 2> gravity{};      // m/s^2
  std::array<double, 4> side_length{};  // m, by Side, of the reactions; 0: none
};

// All corners at a node of the mesh.
std::vector<Corner> corners_at(const TriangleMesh& mesh, int node);

}  // namespace fracfarm::fdem
