#include "solver/fdem/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace fracfarm::fdem {
namespace {

template <class Real, class From>
Field<Real> cast(const From& values) {
  Field<Real> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [](double value) { return static_cast<Real>(value); });
  return out;
}

template <class Real>
TriangleLaw<Real> cast(const TriangleLaw<double>& law) {
  const auto r = [](double value) { return static_cast<Real>(value); };
  return {{r(law.stiffness.C11), r(law.stiffness.C13), r(law.stiffness.C33), r(law.stiffness.C55)},
          {r(law.j2.bulk), r(law.j2.mu), r(law.j2.yield), r(law.j2.hardening)},
          r(law.viscosity),
          r(law.per_mass),
          law.plastic};
}

template <class Real>
law::Joint<Real> cast(const law::Joint<double>& law) {
  const auto r = [](double value) { return static_cast<Real>(value); };
  return {r(law.penalty), r(law.per_onset_n), r(law.per_onset_t), r(law.per_rupture_n), r(law.per_rupture_t)};
}

// Corners tied to a told one move as it is told.
std::map<int, std::vector<int>> tied_to(const Plan& plan) {
  std::map<int, std::vector<int>> tied;
  for (const auto& group : plan.ties)
    for (const int corner : group) tied[corner] = group;
  return tied;
}

template <class Real>
void tell(const Plan& plan, const Body& body, Model<Real>& model) {
  const auto tied = tied_to(plan);
  model.told_of_block.assign(static_cast<std::size_t>(plan.triangle_blocks()), -1);
  int blocks = 0;
  const auto add = [&](int corner, Axis axis, int motion) {
    int& block = model.told_of_block[static_cast<std::size_t>(corner / 3 / lanes)];
    if (block < 0) block = blocks++, model.told.resize(static_cast<std::size_t>(blocks) * corner_count * lanes, Real(0));
    const std::size_t at = at_corner(corner, axis == Axis::z), inside = at % (corner_count * lanes);
    const std::size_t at_told = static_cast<std::size_t>(block) * corner_count * lanes + inside;
    if (model.told[at_told] != Real(0)) return;
    model.told[at_told] = Real(1);
    model.told_dofs.push_back({at, at_told, motion, corner_mass(plan, corner)});
  };
  for (std::size_t motion = 0; motion < body.told.size(); ++motion)
    for (const Corner given : body.told[motion].corners) {
      const int corner = plan.corner_of(given);
      add(corner, body.told[motion].axis, static_cast<int>(motion));
      if (const auto group = tied.find(corner); group != tied.end())
        for (const int other : group->second) add(other, body.told[motion].axis, static_cast<int>(motion));
    }
}

template <class Real>
void pull(const Plan& plan, const Body& body, Model<Real>& model) {
  const auto told = [&](int corner, int axis) {
    const int block = model.told_of_block[static_cast<std::size_t>(corner / 3 / lanes)];
    return block >= 0 &&
           model.told[static_cast<std::size_t>(block) * corner_count * lanes + at_corner(corner, axis) % (corner_count * lanes)] != Real(0);
  };
  const auto add = [&](int corner, int which, double fx, double fz) {
    model.pulled.push_back({corner, which, told(corner, 0) ? 0.0 : fx, told(corner, 1) ? 0.0 : fz});
  };
  for (std::size_t p = 0; p < body.pulls.size(); ++p)
    for (std::size_t i = 0; i < body.pulls[p].corners.size(); ++i)
      add(plan.corner_of(body.pulls[p].corners[i]), static_cast<int>(p), body.pulls[p].force[i][0], body.pulls[p].force[i][1]);
  if (body.gravity[0] == 0.0 && body.gravity[1] == 0.0) return;
  for (const int slot : plan.slot_of)
    for (int k = 0; k < 3; ++k) {
      const double mass = corner_mass(plan, 3 * slot + k);
      add(3 * slot + k, -1, mass * body.gravity[0], mass * body.gravity[1]);
    }
}

template <class Real>
void set_by_corner(const Plan& plan, const std::vector<std::array<double, 2>>& values, Field<Real>& field) {
  for (std::size_t corner = 0; corner < values.size(); ++corner)
    for (int axis = 0; axis < 2; ++axis)
      field[at_corner(plan.corner_of(static_cast<int>(corner)), axis)] = static_cast<Real>(values[corner][static_cast<std::size_t>(axis)]);
}

template <class Real>
void set_springs(const Plan& plan, Scratch<Real>& scratch) {
  scratch.springs = {plan.left_row, plan.right_row, plan.left_slot, plan.right_slot, plan.joint_law_of_block, cast<Real>(plan.length)};
  scratch.stretched.assign(static_cast<std::size_t>(plan.joint_blocks()), 0);
  scratch.place_of.assign(static_cast<std::size_t>(plan.joints), -1);
  scratch.free_place.assign(plan.joint_laws.size(), 0);
  for (int joint = 0; joint < plan.joints; ++joint) {
    const auto& law = plan.joint_laws[static_cast<std::size_t>(plan.joint_law_of_block[static_cast<std::size_t>(joint / lanes)])];
    const double onset = 1.0 / std::max(law.per_onset_n, law.per_onset_t);
    const bool pad = plan.edge_of[static_cast<std::size_t>(joint)] < 0;
    scratch.reach.push_back(pad ? std::numeric_limits<Real>::max() : static_cast<Real>(onset * onset));
  }
}

// A block of pads: no length, between the two spare triangles behind the last.
template <class Real>
void add_block(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int law) {
  const int spare = 3 * plan.slots;
  JointList<Real>& list = scratch.followed;
  list.left_row.insert(list.left_row.end(), lanes, row_of_side(spare)),
      list.right_row.insert(list.right_row.end(), lanes, row_of_side(spare + 3));
  list.left_slot.insert(list.left_slot.end(), lanes, 4 * spare), list.right_slot.insert(list.right_slot.end(), lanes, 4 * (spare + 3));
  list.length.insert(list.length.end(), lanes, Real(0)), list.law_of_block.push_back(law);
  scratch.along.insert(scratch.along.end(), lanes, Real(1)), scratch.along.insert(scratch.along.end(), lanes, Real(0));
  scratch.breaks.push_back(0), scratch.joint_at.insert(scratch.joint_at.end(), lanes, -1);
  state.damage.insert(state.damage.end(), 2 * lanes, Real(0));
  state.opening.insert(state.opening.end(), 4 * lanes, Real(0)), state.force.insert(state.force.end(), 4 * lanes, Real(0));
}

}  // namespace

template <class Real>
void follow(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int joint, const std::array<double, 4>& opening) {
  const std::size_t j = static_cast<std::size_t>(joint);
  const int law_index = plan.joint_law_of_block[j / lanes];
  int& free_place = scratch.free_place[static_cast<std::size_t>(law_index)];
  if (free_place % lanes == 0) free_place = static_cast<int>(scratch.joint_at.size()), add_block(plan, state, scratch, law_index);
  const std::size_t place = static_cast<std::size_t>(free_place++), block = place / lanes, lane = place % lanes;
  state.followed.push_back(joint);
  scratch.joint_at[place] = joint, scratch.place_of[j] = static_cast<int>(place);
  JointList<Real>& list = scratch.followed;
  list.left_row[place] = plan.left_row[j], list.right_row[place] = plan.right_row[j];
  list.left_slot[place] = plan.left_slot[j], list.right_slot[place] = plan.right_slot[j];
  list.length[place] = static_cast<Real>(plan.length[j]);
  for (std::size_t axis = 0; axis < 2; ++axis)
    scratch.along[(block * 2 + axis) * lanes + lane] = static_cast<Real>(plan.along[(j / lanes * 2 + axis) * lanes + j % lanes]);
  const auto& law = plan.joint_laws[static_cast<std::size_t>(law_index)];
  const double furthest = std::max(std::hypot(opening[0], opening[1]), std::hypot(opening[2], opening[3]));
  const double scale = 1.0 / std::max(1.0, furthest * std::max(law.per_onset_n, law.per_onset_t)),
               spring = law.penalty * plan.length[j] / 6.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = (block * 4 + i) * lanes + lane;
    state.opening[at] = static_cast<Real>(scale * opening[i]);
    state.force[at] = static_cast<Real>(scale * spring * (2.0 * opening[i] + opening[(i + 2) % 4]));
  }
  scratch.springs.length[j] = Real(0), scratch.reach[j] = std::numeric_limits<Real>::max();
}

template <class Real>
Model<Real> make_model(const Plan& plan, const Body& body) {
  Model<Real> model;
  model.shape = cast<Real>(plan.shape);
  for (const auto& law : plan.laws) model.laws.push_back(cast<Real>(law)), model.plastic |= law.plastic;
  for (const auto& law : plan.joint_laws) model.joint_laws.push_back(cast<Real>(law));
  tell(plan, body, model);
  pull(plan, body, model);
  return model;
}

template <class Real>
State<Real> make_state(const Plan& plan, const Model<Real>& model, const Body& body) {
  State<Real> state;
  const std::size_t slots = static_cast<std::size_t>(plan.slots);
  state.u.assign(slots * corner_count, Real(0)), state.v.assign(slots * corner_count, Real(0));
  set_by_corner(plan, body.displacement, state.u), set_by_corner(plan, body.velocity, state.v);
  state.slots.assign((slots + 2) * slot_size, Real(0));  // two spare triangles for joints that are pads
  if (model.plastic) state.plastic.assign(slots * 4, Real(0));
  state.break_time.assign(body.mesh.edge_nodes.size(), std::numeric_limits<double>::quiet_NaN());
  state.break_mode.assign(body.mesh.edge_nodes.size(), 0);
  state.extra.assign(slots * row_size, Real(0));
  return state;
}

template <class Real>
Scratch<Real> make_scratch(const Plan& plan, const Model<Real>& model, const Body&) {
  Scratch<Real> scratch;
  scratch.rows.assign((static_cast<std::size_t>(plan.slots) + 2) * row_size, Real(0));
  scratch.told_velocity.assign(model.told.size(), Real(0)), scratch.told_force.assign(model.told.size(), Real(0));
  set_springs(plan, scratch);
  scratch.told_before.assign(model.told_dofs.size(), 0.0);
  scratch.needs.assign(static_cast<std::size_t>(plan.triangle_blocks()), 0);
  for (std::size_t b = 0; b < scratch.needs.size(); ++b)
    if (model.told_of_block[b] >= 0) scratch.needs[b] |= needs_told;
  for (const PulledCorner& pulled : model.pulled) {
    scratch.needs[static_cast<std::size_t>(pulled.corner / 3 / lanes)] |= needs_extra;
    scratch.extra_slots.push_back(pulled.corner / 3);
  }
  std::sort(scratch.extra_slots.begin(), scratch.extra_slots.end());
  scratch.extra_slots.erase(std::unique(scratch.extra_slots.begin(), scratch.extra_slots.end()), scratch.extra_slots.end());
  return scratch;
}

#define FRACFARM_INSTANTIATE(Real)                                                                    \
  template Model<Real> make_model(const Plan&, const Body&);                                          \
  template State<Real> make_state(const Plan&, const Model<Real>&, const Body&);                      \
  template void follow(const Plan&, State<Real>&, Scratch<Real>&, int, const std::array<double, 4>&); \
  template Scratch<Real> make_scratch(const Plan&, const Model<Real>&, const Body&);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
