#include "solver/boundary.hpp"

#include <algorithm>
#include <set>

namespace fracfarm {
namespace {

bool is_vertical(Side side) { return side == Side::left || side == Side::right; }
Axis normal_axis(Side side) { return is_vertical(side) ? Axis::x : Axis::z; }
Axis tangential_axis(Side side) { return is_vertical(side) ? Axis::z : Axis::x; }
double outward(Side side) { return side == Side::right || side == Side::top ? 1.0 : -1.0; }

// Ends of a part are the scene's decimal numbers, nodes are multiples of h: equal up to rounding counts as inside.
bool inside(const SideLoad& load, const SideNode& node, double side_length) {
  const double slack = 1e-9 * side_length;
  return node.at >= load.from - slack && node.at <= load.to + slack;
}

using Claimed = std::set<std::pair<Axis, std::size_t>>;

void add_motion(Boundary& boundary, Claimed& claimed, Motion motion, const SideLoad& load, std::span<const SideNode> nodes) {
  const double length = nodes.empty() ? 0.0 : nodes.back().to;
  for (const SideNode& node : nodes)
    if (inside(load, node, length) && claimed.emplace(motion.axis, node.index).second) motion.nodes.push_back(node.index);
  if (!motion.nodes.empty()) boundary.motions.push_back(std::move(motion));
}

void add_normal(Boundary& boundary, Claimed& claimed, Side side, const SideLoad& load, std::span<const SideNode> nodes) {
  if (!load.normal_velocity) return;
  add_motion(boundary, claimed, {side, normal_axis(side), true, outward(side) * *load.normal_velocity, load.ramp, {}}, load, nodes);
}

void add_tangential(Boundary& boundary, Claimed& claimed, Side side, const SideLoad& load, std::span<const SideNode> nodes) {
  if (load.tangential == Tangential::free) return;
  const double velocity = load.tangential == Tangential::velocity ? load.tangential_velocity : 0.0;
  add_motion(boundary, claimed, {side, tangential_axis(side), false, velocity, load.ramp, {}}, load, nodes);
}

void add_traction(Boundary& boundary, const Claimed& claimed, const SideLoad& load, std::span<const SideNode> nodes) {
  if (!load.traction) return;
  Traction traction{load.ramp, {}, {}, {}};
  for (const SideNode& node : nodes) {
    const double stretch = std::min(node.to, load.to) - std::max(node.from, load.from);
    if (stretch <= 0.0) continue;
    traction.nodes.push_back(node.index);
    traction.fx.push_back(claimed.count({Axis::x, node.index}) ? 0.0 : stretch * (*load.traction)[0]);
    traction.fz.push_back(claimed.count({Axis::z, node.index}) ? 0.0 : stretch * (*load.traction)[1]);
  }
  if (!traction.nodes.empty()) boundary.tractions.push_back(std::move(traction));
}

}  // namespace

double ramp_share(double time, double ramp) { return ramp > 0.0 ? std::clamp(time / ramp, 0.0, 1.0) : 1.0; }

double Motion::at(double time) const { return velocity * ramp_share(time, ramp); }

double Traction::share(double time) const { return ramp_share(time, ramp); }

Boundary build_boundary(const Scene& scene, const SideNodes& nodes) {
  Boundary boundary;
  Claimed claimed;
  const auto on = [&](Side side) -> std::span<const SideNode> { return nodes[static_cast<std::size_t>(side)]; };
  for (Side side : all_sides)
    for (const SideLoad& load : scene.on(side)) add_normal(boundary, claimed, side, load, on(side));
  for (Side side : all_sides)
    for (const SideLoad& load : scene.on(side)) add_tangential(boundary, claimed, side, load, on(side));
  for (Side side : all_sides)
    for (const SideLoad& load : scene.on(side)) add_traction(boundary, claimed, load, on(side));
  return boundary;
}

bool is_loaded(const Scene& scene, Side side) {
  return std::any_of(scene.on(side).begin(), scene.on(side).end(), [](const SideLoad& load) {
    const bool moves =
        load.normal_velocity.value_or(0.0) != 0.0 || (load.tangential == Tangential::velocity && load.tangential_velocity != 0.0);
    const bool pulls = load.traction && ((*load.traction)[0] != 0.0 || (*load.traction)[1] != 0.0);
    return moves || pulls;
  });
}

}  // namespace fracfarm
