#include "solver/fdem/followed.hpp"

#include <algorithm>
#include <array>

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

int law_of(const Plan& plan, int joint) { return plan.joint_law_of_block[static_cast<Index>(joint / lanes)]; }

// m^2: a spring of the law that opens less at both ends does not soften.
template <class Real>
Real reach_of(const law::Joint<double>& law) {
  const double onset = 1.0 / std::max(law.per_onset_n, law.per_onset_t);
  return static_cast<Real>(onset * onset);
}

// Pads have no length and lie between the two spare triangles behind the last.
template <class Real>
void add_block_of_pads(const Plan& plan, JointList<Real>& list, int law) {
  const int spare = 3 * plan.slots;
  const auto add = [](std::vector<int>& values, int value) { values.insert(values.end(), lanes, value); };
  add(list.left_row, row_of_side(spare)), add(list.right_row, row_of_side(spare + 3));
  add(list.left_slot, 4 * spare), add(list.right_slot, 4 * (spare + 3));
  add(list.joint_at, -1);
  list.length.insert(list.length.end(), lanes, Real(0));
  list.along.insert(list.along.end(), lanes, Real(1)), list.along.insert(list.along.end(), lanes, Real(0));
  list.law_of_block.push_back(law);
}

template <class Real>
void put(const Plan& plan, JointList<Real>& list, Index place, int joint) {
  const Index j = static_cast<Index>(joint);
  list.left_row[place] = plan.left_row[j], list.right_row[place] = plan.right_row[j];
  list.left_slot[place] = plan.left_slot[j], list.right_slot[place] = plan.right_slot[j];
  list.length[place] = static_cast<Real>(plan.length[j]);
  for (Index axis = 0; axis < 2; ++axis) list.along[in_block(place, 2, axis)] = static_cast<Real>(plan.along[in_block(j, 2, axis)]);
  list.joint_at[place] = joint;
}

template <class Real>
void make_pad(const Plan& plan, JointList<Real>& list, Index place) {
  const int spare = 3 * plan.slots;
  list.left_row[place] = row_of_side(spare), list.right_row[place] = row_of_side(spare + 3);
  list.left_slot[place] = 4 * spare, list.right_slot[place] = 4 * (spare + 3);
  list.length[place] = Real(0), list.joint_at[place] = -1;
}

// See JointList::ready and first_chunk.
template <class Real>
void find_ready(const Plan& plan, JointList<Real>& list) {
  list.ready.assign(static_cast<Index>((plan.triangle_blocks() + triangle_chunk - 1) / triangle_chunk), 0);
  list.first_chunk.assign(list.law_of_block.size(), static_cast<int>(list.ready.size()));
  int last = 0;
  for (Index place = 0; place < list.joint_at.size(); ++place) {
    const int joint = list.joint_at[place];
    int& first = list.first_chunk[place / lanes];
    if (joint >= 0) {
      const Index j = static_cast<Index>(joint);
      const auto [earlier, later] = std::minmax(plan.left_side[j], plan.right_side[j]);
      first = std::min(first, earlier / (3 * lanes * triangle_chunk)), last = std::max(last, later / (3 * lanes * triangle_chunk));
    }
    if (place % lanes == lanes - 1) list.ready[static_cast<Index>(last)] = static_cast<int>(place / lanes) + 1;
  }
  for (Index c = 1; c < list.ready.size(); ++c) list.ready[c] = std::max(list.ready[c], list.ready[c - 1]);
}

template <class Real>
void add_followed_block(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int law) {
  add_block_of_pads(plan, scratch.followed, law);
  scratch.breaks.push_back(0), scratch.grew.push_back(0xffff);
  scratch.kept.insert(scratch.kept.end(), 2 * lanes, Real(1));
  state.damage.insert(state.damage.end(), 2 * lanes, Real(0));
  state.opening.insert(state.opening.end(), 4 * lanes, Real(0)), state.force.insert(state.force.end(), 4 * lanes, Real(0));
}

// The place of a joint in the last block of its law, or in a new one.
template <class Real>
Index take_place(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int joint) {
  const Index j = static_cast<Index>(joint);
  int& free_place = scratch.free_place[static_cast<Index>(law_of(plan, joint))];
  if (free_place % lanes == 0) {
    free_place = static_cast<int>(scratch.followed.joint_at.size());
    add_followed_block(plan, state, scratch, law_of(plan, joint));
  }
  const Index place = static_cast<Index>(free_place++);
  put(plan, scratch.followed, place, joint);
  state.followed.push_back(joint), scratch.place_of[j] = static_cast<int>(place);
  return place;
}

template <class Real>
void forget_places(const Plan& plan, State<Real>& state, Scratch<Real>& scratch) {
  state.followed.clear(), state.damage.clear(), state.opening.clear(), state.force.clear();
  scratch.followed = {}, scratch.kept.clear(), scratch.breaks.clear(), scratch.grew.clear();
  scratch.free_place.assign(plan.joint_laws.size(), 0);
}

// Those that are followed now are settled: others come in blocks of their own.
template <class Real>
void close(const Plan& plan, State<Real>& state, Scratch<Real>& scratch) {
  state.settled = static_cast<int>(state.followed.size());
  scratch.settled_blocks = scratch.followed.blocks();
  scratch.free_place.assign(plan.joint_laws.size(), 0);
  find_ready(plan, scratch.followed);
  set_springs(plan, scratch);
}

template <class Real>
void copy(const Field<Real>& from, Index old_place, Field<Real>& to, Index place, Index numbers) {
  for (Index i = 0; i < numbers; ++i) to[in_block(place, numbers, i)] = from[in_block(old_place, numbers, i)];
}

}  // namespace

template <class Real>
void set_springs(const Plan& plan, Scratch<Real>& scratch) {
  scratch.springs = {}, scratch.reach.clear();
  for (const auto& law : plan.joint_laws) scratch.reach.push_back(reach_of<Real>(law));
  scratch.spring_of.assign(static_cast<Index>(plan.joints), -1);
  Index next = 0;
  for (int joint = 0; joint < plan.joints; ++joint) {
    const Index j = static_cast<Index>(joint);
    if (plan.edge_of[j] < 0 || scratch.place_of[j] >= 0) continue;
    const int law = law_of(plan, joint);
    if (scratch.springs.law_of_block.empty() || scratch.springs.law_of_block.back() != law) next = scratch.springs.joint_at.size();
    if (next == scratch.springs.joint_at.size()) {
      add_block_of_pads(plan, scratch.springs, law);
    }
    put(plan, scratch.springs, next, joint);
    scratch.spring_of[j] = static_cast<int>(next++);
  }
  scratch.softens.assign(scratch.springs.law_of_block.size(), 0);
  find_ready(plan, scratch.springs);
}

template <class Real>
void follow(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int joint, const law::Ends<double>& opening) {
  const Index j = static_cast<Index>(joint), place = take_place(plan, state, scratch, joint);
  const double spring = plan.joint_laws[static_cast<Index>(law_of(plan, joint))].penalty * plan.length[j] / 6.0;
  const std::array<double, 4> at_onset{opening.ax, opening.az, opening.bx, opening.bz};
  for (Index i = 0; i < 4; ++i) {
    state.opening[in_block(place, 4, i)] = static_cast<Real>(at_onset[i]);
    state.force[in_block(place, 4, i)] = static_cast<Real>(spring * (2.0 * at_onset[i] + at_onset[(i + 2) % 4]));
  }
  make_pad(plan, scratch.springs, static_cast<Index>(scratch.spring_of[j]));
}

template <class Real>
bool is_unsettled(const State<Real>& state) {
  const Index settled = static_cast<Index>(state.settled);
  return state.followed.size() > settled + settled / 16 + 128;
}

template <class Real>
void settle(const Plan& plan, State<Real>& state, Scratch<Real>& scratch) {
  std::vector<int> joints = state.followed;
  std::sort(joints.begin(), joints.end());
  const std::vector<int> old_place = scratch.place_of;
  const Field<Real> damage = state.damage, kept = scratch.kept, opening = state.opening, force = state.force;
  forget_places(plan, state, scratch);
  for (const int joint : joints) {
    const Index old = static_cast<Index>(old_place[static_cast<Index>(joint)]), place = take_place(plan, state, scratch, joint);
    copy(damage, old, state.damage, place, 2), copy(kept, old, scratch.kept, place, 2);
    copy(opening, old, state.opening, place, 4), copy(force, old, state.force, place, 4);
  }
  close(plan, state, scratch);
}

template <class Real>
bool follow_again(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, const std::vector<int>& joints, int settled) {
  if (settled < 0 || static_cast<Index>(settled) > joints.size()) return false;
  for (const int joint : joints) {
    const bool known = joint >= 0 && joint < plan.joints && plan.edge_of[static_cast<Index>(joint)] >= 0;
    if (!known || scratch.place_of[static_cast<Index>(joint)] >= 0) return false;
    if (state.followed.size() == static_cast<Index>(settled)) close(plan, state, scratch);
    follow(plan, state, scratch, joint, {});
  }
  if (joints.size() == static_cast<Index>(settled)) close(plan, state, scratch);
  return true;
}

template <class Real>
void set_kept(const State<Real>& state, Scratch<Real>& scratch, Curve curve) {
  std::transform(state.damage.begin(), state.damage.end(), scratch.kept.begin(), [&](Real damage) {
    return curve == Curve::munjiza ? law::kept<law::Munjiza>(damage) : law::kept<law::LinearSoftening>(damage);
  });
}

#define FRACFARM_INSTANTIATE(Real)                                                                     \
  template void set_springs(const Plan&, Scratch<Real>&);                                              \
  template void follow(const Plan&, State<Real>&, Scratch<Real>&, int, const law::Ends<double>&);      \
  template bool is_unsettled(const State<Real>&);                                                      \
  template void settle(const Plan&, State<Real>&, Scratch<Real>&);                                     \
  template bool follow_again(const Plan&, State<Real>&, Scratch<Real>&, const std::vector<int>&, int); \
  template void set_kept(const State<Real>&, Scratch<Real>&, Curve);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
