#include "solver/fdem/followed.hpp"

#include <algorithm>
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

}  // namespace

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
  scratch.place_of.assign(static_cast<std::size_t>(plan.joints), -1);
  scratch.free_place.assign(plan.joint_laws.size(), 0);
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

#define FRACFARM_INSTANTIATE(Real)                                               \
  template Model<Real> make_model(const Plan&, const Body&);                     \
  template State<Real> make_state(const Plan&, const Model<Real>&, const Body&); \
  template Scratch<Real> make_scratch(const Plan&, const Model<Real>&, const Body&);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
