// Everything about a body that stays as it is during a run, in double and in the order of the kernels: triangles along a Hilbert curve in
// blocks of one material, joints along their triangles, whole blocks by pads that move nowhere.
#pragma once

#include <span>
#include <vector>

#include "common/scene/scene.hpp"
#include "solver/fdem/body.hpp"
#include "solver/fdem/contact/contact.hpp"
#include "solver/fdem/kernels.hpp"

namespace fracfarm::fdem {

struct Plan {
  // Triangles; a slot is a place in the kernels' order.
  int slots = 0;                 // a multiple of `lanes`
  std::vector<int> slot_of;      // by triangle
  std::vector<int> triangle_of;  // by slot, -1: a pad
  std::vector<double> shape;     // as View::shape
  std::vector<TriangleLaw<double>> laws;
  std::vector<int> law_of_block;
  std::vector<double> corner_rows;  // by slot, rows of row_size: undeformed corners, m
  std::vector<int> crack_sides;     // of initial cracks, 3 slot + k
  ContactSettings contact;
  std::vector<int> neighbour;  // by side 3 slot + k: the side across, -1 on the boundary
  // Joints.
  int joints = 0;                          // a multiple of `lanes`
  std::vector<int> edge_of;                // by joint, -1: a pad
  std::vector<int> joint_of;               // by edge, -1: none (a crack, or asleep)
  std::vector<int> left_side, right_side;  // by joint, 3 slot + k
  std::vector<int> left_row, right_row, left_slot, right_slot;
  std::vector<double> length, along;  // as in View
  std::vector<law::Joint<double>> joint_laws;
  std::vector<int> joint_law_of_block;
  // Corners (3 slot + k) that move as one.
  std::vector<std::vector<int>> ties;
  double area = 0.0;             // m^2
  double length_per_area = 0.0;  // of joints, 1/m

  int triangle_blocks() const { return slots / lanes; }
  int joint_blocks() const { return joints / lanes; }
  int corner_of(Corner corner) const { return 3 * slot_of[static_cast<std::size_t>(corner / 3)] + corner % 3; }
};

// Where number i of the `numbers` of a place lies in arrays [block][numbers][lane].
constexpr std::size_t in_block(std::size_t place, std::size_t numbers, std::size_t i) {
  return (place / lanes * numbers + i) * lanes + place % lanes;
}

// Where a number of corner 3 slot + k, axis 0 (x) or 1 (z), lies in arrays [block][corner_count][lane].
inline std::size_t at_corner(int corner, int axis) {
  const int slot = corner / 3, k = corner % 3;
  return static_cast<std::size_t>(((slot / lanes) * corner_count + 2 * k + axis) * lanes + slot % lanes);
}
// Where the first of the four numbers of side 3 slot + k lies in rows of row_size.
constexpr int row_of_side(int side) { return (side / 3) * row_size + 2 * (side % 3); }
// And in rows of row_size.
inline std::size_t in_row(int corner, int axis) { return static_cast<std::size_t>((corner / 3) * row_size + 2 * (corner % 3) + axis); }

// kg/m.
double corner_mass(const Plan& plan, int corner);

Plan make_plan(const Body& body, const FdemSettings& settings);

}  // namespace fracfarm::fdem
