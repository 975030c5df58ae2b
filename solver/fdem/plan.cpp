#include "solver/fdem/plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "solver/fdem/materials.hpp"
#include "solver/fdem/order.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

int material_of(const Body& body, int t) { return body.material_of.empty() ? 0 : body.material_of[static_cast<Index>(t)]; }
bool is_asleep(const Body& body, Index edge) { return !body.asleep.empty() && body.asleep[edge] != 0; }
bool is_joint(const Body& body, Index edge) { return body.mesh.edge_kind[edge] == EdgeKind::joint && !is_asleep(body, edge); }

double length_of(const TriangleMesh& mesh, Index edge) {
  const auto &a = mesh.nodes[static_cast<Index>(mesh.edge_nodes[edge][0])], &b = mesh.nodes[static_cast<Index>(mesh.edge_nodes[edge][1])];
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

double area_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto &a = mesh.nodes[static_cast<Index>(triangle[0])], &b = mesh.nodes[static_cast<Index>(triangle[1])],
             &c = mesh.nodes[static_cast<Index>(triangle[2])];
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
}

void measure_body(const Body& body, Plan& plan) {
  for (const auto& triangle : body.mesh.triangles) plan.area += area_of(body.mesh, triangle);
  double length = 0.0;
  for (Index edge = 0; edge < body.mesh.edge_nodes.size(); ++edge)
    if (is_joint(body, edge)) length += length_of(body.mesh, edge);
  plan.length_per_area = length / plan.area;
}

// B = (edges from corner 0)^-1, and what belongs to it.
void set_shape(Plan& plan, int slot, const double* row, double per_mass) {
  const double x1 = row[2] - row[0], z1 = row[3] - row[1], x2 = row[4] - row[0], z2 = row[5] - row[1];
  const double twice = x1 * z2 - x2 * z1;
  const double values[shape_count] = {z2 / twice, -x2 / twice, -z1 / twice, x1 / twice, 0.5 * twice, per_mass / (0.5 * twice)};
  for (int i = 0; i < shape_count; ++i)
    plan.shape[static_cast<Index>(((slot / lanes) * shape_count + i) * lanes + slot % lanes)] = values[i];
}

void set_corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle, double* row) {
  for (int k = 0; k < 4; ++k) {
    const auto& node = mesh.nodes[static_cast<Index>(triangle[static_cast<Index>(k % 3)])];
    row[2 * k] = node[0], row[2 * k + 1] = node[1];
  }
}

// Pads have the shape of a real triangle, so that nothing divides by zero, and neither area nor inverse mass.
void place_triangles(const Body& body, const FdemSettings& settings, Plan& plan) {
  plan.triangle_of = triangle_order(body, lanes);
  plan.slots = static_cast<int>(plan.triangle_of.size());
  plan.slot_of.resize(body.mesh.triangles.size());
  plan.shape.assign(plan.triangle_of.size() * shape_count, 0.0);
  plan.corner_rows.assign(plan.triangle_of.size() * row_size, 0.0);
  for (const Material& material : body.materials) plan.laws.push_back(triangle_law(material, settings, plan.length_per_area));
  int last = plan.triangle_of.front();
  for (int slot = 0; slot < plan.slots; ++slot) {
    const int t = plan.triangle_of[static_cast<Index>(slot)];
    if (t >= 0) last = t, plan.slot_of[static_cast<Index>(t)] = slot;
    const int material = material_of(body, last);
    if (slot % lanes == 0) plan.law_of_block.push_back(material);
    double* row = &plan.corner_rows[static_cast<Index>(slot) * row_size];
    set_corners(body.mesh, body.mesh.triangles[static_cast<Index>(last)], row);
    if (t >= 0) set_shape(plan, slot, row, plan.laws[static_cast<Index>(material)].per_mass);
  }
}

void set_contact(const Body& body, const FdemSettings& settings, Plan& plan) {
  for (const Material& material : body.materials) {
    plan.contact.friction = std::max(plan.contact.friction, material.cohesion->friction);
    plan.contact.penalty = std::max(plan.contact.penalty, contact_penalty_of(material, settings));
  }
  if (body.materials.size() < 2) return;
  for (int slot = 0; slot < plan.slots; ++slot) {
    const int material = plan.law_of_block[static_cast<Index>(slot / lanes)];
    plan.contact.triangle_penalty.push_back(contact_penalty_of(body.materials[static_cast<Index>(material)], settings));
  }
}

// Which edge of the triangle goes from node a to node b.
int edge_in(const std::array<int, 3>& triangle, int a, int b) {
  for (int k = 0; k < 3; ++k)
    if (triangle[static_cast<Index>(k)] == a && triangle[static_cast<Index>((k + 1) % 3)] == b) return k;
  return 0;
}

struct Sides {
  int left, right;
};

Sides sides_of(const Body& body, const Plan& plan, Index edge) {
  const auto [a, b] = body.mesh.edge_nodes[edge];
  const auto [left, right] = body.mesh.edge_triangles[edge];
  const auto side = [&](int t, int from, int to) {
    return 3 * plan.slot_of[static_cast<Index>(t)] + edge_in(body.mesh.triangles[static_cast<Index>(t)], from, to);
  };
  return {side(left, a, b), side(right, b, a)};
}

void join_neighbours(const Body& body, Plan& plan) {
  plan.neighbour.assign(static_cast<Index>(plan.slots) * 3, -1);
  for (Index edge = 0; edge < body.mesh.edge_nodes.size(); ++edge) {
    const Sides sides = sides_of(body, plan, edge);
    plan.neighbour[static_cast<Index>(sides.left)] = sides.right;
    plan.neighbour[static_cast<Index>(sides.right)] = sides.left;
    if (body.mesh.edge_kind[edge] == EdgeKind::crack) plan.crack_sides.push_back(sides.left), plan.crack_sides.push_back(sides.right);
  }
}

struct Pair {  // of materials, smaller first
  int first, second;
  auto operator<=>(const Pair&) const = default;
};

Pair materials_of(const Body& body, Index edge) {
  const auto [left, right] = body.mesh.edge_triangles[edge];
  const int a = material_of(body, left), b = material_of(body, right);
  return {std::min(a, b), std::max(a, b)};
}

// Edges with joints, those of one pair of materials after another, each after both its triangles.
std::vector<std::pair<Pair, int>> ordered_joints(const Body& body, const Plan& plan) {
  std::vector<std::tuple<Pair, int, int, int>> keyed;
  for (Index edge = 0; edge < body.mesh.edge_nodes.size(); ++edge) {
    if (!is_joint(body, edge)) continue;
    const Sides sides = sides_of(body, plan, edge);
    keyed.emplace_back(materials_of(body, edge), std::max(sides.left, sides.right), std::min(sides.left, sides.right),
                       static_cast<int>(edge));
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::pair<Pair, int>> ordered;
  for (const auto& [pair, later, earlier, edge] : keyed) ordered.emplace_back(pair, edge);
  return ordered;
}

void add_joint(const Body& body, Plan& plan, int edge) {
  const int joint = plan.joints++;
  if (joint % lanes == 0) plan.along.resize(plan.along.size() + 2 * lanes, 0.0);
  const Index at = static_cast<Index>((joint / lanes) * 2 * lanes + joint % lanes);
  plan.edge_of.push_back(edge);
  if (edge < 0) {  // a pad: a joint of no length between the two spare triangles behind the last
    const int spare = 3 * plan.slots;
    plan.left_side.push_back(spare), plan.right_side.push_back(spare + 3), plan.length.push_back(0.0);
    plan.along[at] = 1.0;
  } else {
    const Index e = static_cast<Index>(edge);
    const Sides sides = sides_of(body, plan, e);
    plan.joint_of[e] = joint;
    plan.left_side.push_back(sides.left), plan.right_side.push_back(sides.right);
    plan.length.push_back(length_of(body.mesh, e));
    const auto &a = body.mesh.nodes[static_cast<Index>(body.mesh.edge_nodes[e][0])],
               &b = body.mesh.nodes[static_cast<Index>(body.mesh.edge_nodes[e][1])];
    plan.along[at] = b[0] - a[0], plan.along[at + lanes] = b[1] - a[1];
  }
  plan.left_row.push_back(row_of_side(plan.left_side.back())), plan.right_row.push_back(row_of_side(plan.right_side.back()));
  plan.left_slot.push_back(4 * plan.left_side.back()), plan.right_slot.push_back(4 * plan.right_side.back());
}

void place_joints(const Body& body, const FdemSettings& settings, Plan& plan) {
  plan.joint_of.assign(body.mesh.edge_nodes.size(), -1);
  const auto fill = [&] {
    while (plan.joints % lanes != 0) add_joint(body, plan, -1);
  };
  Pair last{-1, -1};
  for (const auto& [pair, edge] : ordered_joints(body, plan)) {
    if (pair != last) {
      fill();
      last = pair;
      plan.joint_laws.push_back(
          joint_law(body.materials[static_cast<Index>(pair.first)], body.materials[static_cast<Index>(pair.second)], settings));
    }
    if (plan.joints % lanes == 0) plan.joint_law_of_block.push_back(static_cast<int>(plan.joint_laws.size()) - 1);
    add_joint(body, plan, edge);
  }
  fill();
}

int root(std::vector<int>& parent, int corner) {
  while (parent[static_cast<Index>(corner)] != corner)
    corner = parent[static_cast<Index>(corner)] = parent[static_cast<Index>(parent[static_cast<Index>(corner)])];
  return corner;
}

void tie_corners(const Body& body, Plan& plan) {
  if (body.asleep.empty()) return;
  std::vector<int> parent(static_cast<Index>(plan.slots) * 3);
  std::iota(parent.begin(), parent.end(), 0);
  const auto next = [](int side) { return side - side % 3 + (side % 3 + 1) % 3; };
  const auto tie = [&](int p, int q) {
    const int a = root(parent, p), b = root(parent, q);
    parent[static_cast<Index>(std::max(a, b))] = std::min(a, b);
  };
  for (Index edge = 0; edge < body.mesh.edge_nodes.size(); ++edge) {
    if (!is_asleep(body, edge)) continue;
    const Sides sides = sides_of(body, plan, edge);  // side 3 t + k starts at corner k
    tie(sides.left, next(sides.right));
    tie(next(sides.left), sides.right);
  }
  std::map<int, std::vector<int>> groups;
  for (int corner = 0; corner < 3 * plan.slots; ++corner) groups[root(parent, corner)].push_back(corner);
  for (auto& [first, corners] : groups)
    if (corners.size() > 1) plan.ties.push_back(std::move(corners));
}

}  // namespace

std::vector<Corner> corners_at(const TriangleMesh& mesh, int node) {
  std::vector<Corner> corners;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[t][static_cast<Index>(k)] == node) corners.push_back(static_cast<int>(3 * t) + k);
  return corners;
}

double corner_mass(const Plan& plan, int corner) {
  const int slot = corner / 3;
  const double per_mass = plan.shape[static_cast<Index>(((slot / lanes) * shape_count + 5) * lanes + slot % lanes)];
  return per_mass > 0.0 ? 1.0 / per_mass : 0.0;
}

Plan make_plan(const Body& body, const FdemSettings& settings) {
  Plan plan;
  measure_body(body, plan);
  place_triangles(body, settings, plan);
  set_contact(body, settings, plan);
  join_neighbours(body, plan);
  place_joints(body, settings, plan);
  tie_corners(body, plan);
  return plan;
}

}  // namespace fracfarm::fdem
