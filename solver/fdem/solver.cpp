#include "solver/fdem/solver.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/fdem/followed.hpp"
#include "solver/fdem/materials.hpp"
#include "solver/fdem/stable_step.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

bool sides_exist(const std::vector<int>& sides, const Plan& plan) {
  return std::all_of(sides.begin(), sides.end(), [&](int side) { return side >= 0 && side < 3 * plan.slots; });
}

}  // namespace

template <class Real>
Fdem<Real>::Fdem(Body body, const FdemSettings& settings, const Rules& rules, int threads, const Kernels<Real>& kernels)
    : body_(std::move(body)),
      settings_(settings),
      rules_(rules),
      threads_(threads),
      kernels_(kernels),
      plan_(make_plan(body_, settings)),
      model_(make_model<Real>(plan_, body_)),
      state_(make_state(plan_, model_, body_)),
      scratch_(make_scratch(plan_, model_, body_)),
      contact_(plan_.corner_rows, plan_.neighbour, plan_.contact) {}

template <class Real>
View<Real> Fdem<Real>::view() const {
  auto& s = const_cast<State<Real>&>(state_);
  View<Real> v{};
  v.shape = model_.shape.data(), v.laws = model_.laws.data(), v.law_of_block = plan_.law_of_block.data();
  v.u = s.u.data(), v.v = s.v.data(), v.rows = scratch_.rows.data(), v.slots = s.slots.data();
  v.plastic = s.plastic.data(), v.needs = scratch_.needs.data(), v.extra = s.extra.data();
  v.told_of_block = model_.told_of_block.data(), v.told = model_.told.data();
  v.told_velocity = scratch_.told_velocity.data(), v.told_force = scratch_.told_force.data();
  v.springs = scratch_.springs.places(), v.followed = scratch_.followed.places();
  v.reach = scratch_.reach.data(), v.softens = scratch_.softens.data();
  v.breaks = scratch_.breaks.data(), v.grew = scratch_.grew.data();
  v.damage = s.damage.data(), v.kept = scratch_.kept.data(), v.opening = s.opening.data(), v.force = s.force.data();
  v.joint_laws = model_.joint_laws.data();
  v.curve = curve_of(settings_);
  v.always_flow = !rules_.flow_where_it_yields;
  // Past the edge of the step v- v+ is less than 0 and hides what grows: counted as 0, it shows as energy that nobody brought. Corners that
  // are tied have their common v+ only after the kick: there the sum alone is right.
  v.least_kinetic = plan_.ties.empty() ? Real(0) : std::numeric_limits<Real>::lowest();
  return v;
}

template <class Real>
void Fdem<Real>::put_rows() {
  for (int slot = 0; slot < plan_.slots; ++slot)
    for (int k = 0; k < 4; ++k)
      for (int axis = 0; axis < 2; ++axis)
        scratch_.rows[static_cast<Index>(slot * row_size + 2 * k + axis)] = state_.u[at_corner(3 * slot + k % 3, axis)];
}

// The velocities half a step before t = 0 that the initial ones and the forces at t = 0 ask for.
template <class Real>
void Fdem<Real>::step_back(double dt) {
  const Field<Real> u = state_.u, plastic = state_.plastic;
  tell_velocities(-0.5 * dt);
  advance(-0.5 * dt);
  state_.u = u, state_.plastic = plastic;
  put_rows();
}

template <class Real>
Result<void> Fdem<Real>::start(double dt) {
  dt_ = dt;
  measure_cracks();
  put_rows();
  if (!rules_.damage_where_stretched)
    for (int joint = 0; joint < plan_.joints; ++joint)
      if (plan_.edge_of[static_cast<Index>(joint)] >= 0) follow(plan_, state_, scratch_, joint, {});
  join();
  soften(0.0);
  pull(0.0);
  for (const Corner side : body_.exposed) expose(plan_.corner_of(side));
  expose_cracks_that_close();
  contact_.add_forces(scratch_.rows.data(), state_.extra.data());
  double given = 0.0;  // J/m, by velocities that are told from the start
  remember_told();
  step_back(dt);
  for (Index i = 0; i < model_.told_dofs.size(); ++i) {
    const ToldDof& dof = model_.told_dofs[i];
    const double before = scratch_.told_before[i], now = state_.v[dof.at];
    given += 0.5 * dof.mass * (now * now - before * before);
  }
  tell_velocities(0.5 * dt);
  const TriangleSums sums = measure(dt);
  state_.ledger.external_work = given;
  state_.ledger.initial_energy = sums.kinetic + sums.elastic + sums.joints - given;
  return {};
}

template <class Real>
Result<void> Fdem<Real>::step(long long n, double dt) {
  const double now = static_cast<double>(n) * dt, next = static_cast<double>(n + 1) * dt;
  Ledger& ledger = state_.ledger;
  auto& clock = scratch_.clock;
  dt_ = dt;
  clock.begin();
  remember_told();
  const double pulls_before = power_of_pulls(now);
  clock.end(Stage::boundary);
  const bool at_once = plan_.ties.empty();
  const AdvanceSums moved = at_once ? advance_and_join(dt) : advance(dt);
  clock.end(Stage::triangles);
  move_as_one(dt);
  const Powers told = power_of_told(dt);
  const double before = n > 0 ? told.before + pulls_before : 0.0;
  ledger.external_work += 0.5 * dt * (before + told.after + power_of_pulls(now));
  ledger.viscous += n > 0 ? dt * moved.viscous : 0.0;
  ledger.plastic += moved.plastic;
  pull(next);
  tell_velocities(next + 0.5 * dt);
  clock.end(Stage::boundary);
  if (!at_once) join();
  soften(next);
  clock.end(Stage::joints);
  expose_cracks_that_close();
  contact_.add_forces(scratch_.rows.data(), state_.extra.data());
  clock.end(Stage::contact);
  return {};
}

template <class Real>
double Fdem<Real>::mean_stress_zz() const {
  return measure(dt_).stress_zz / plan_.area;
}

template <class Real>
SampleRow Fdem<Real>::sample(long long n, double dt) const {
  const double time = static_cast<double>(n) * dt;
  const Ledger& ledger = state_.ledger;
  remember_told();
  const TriangleSums sums = measure(dt);
  const Powers told = power_of_told(dt);
  SampleRow row;
  row.step_time = time, row.dt = dt;
  row.stress_xx = sums.stress_xx / plan_.area, row.stress_zz = sums.stress_zz / plan_.area;
  row.reaction = reactions(dt);
  row.crack_length = ledger.crack_length;
  row.kinetic_energy = sums.kinetic;
  row.elastic_energy = sums.elastic + sums.joints;
  row.plastic_energy = ledger.plastic + sums.plastic;
  const ContactEnergies& contact = contact_.energies();
  row.contact_energy = contact.stored, row.friction_energy = contact.friction;
  row.fracture_energy = ledger.fracture - contact.jumped;  // what broken joints leave to contact is not gone
  row.viscous_energy = ledger.viscous + (n > 0 ? dt * sums.viscous : 0.0);
  row.external_work = ledger.external_work + (n > 0 ? 0.5 * dt * (told.before + power_of_pulls(time)) : 0.0);
  row.energy_residual = energy_residual(row, ledger.initial_energy);
  return row;
}

template <class Real>
std::vector<float> Fdem<Real>::stored_damage() const {
  std::vector<float> damage(body_.mesh.edge_nodes.size(), 0.0F);
  for (Index edge = 0; edge < damage.size(); ++edge) {
    const int joint = plan_.joint_of[edge];
    if (body_.mesh.edge_kind[edge] == EdgeKind::crack) damage[edge] = 2.0F;
    if (joint < 0) continue;
    const int place = scratch_.place_of[static_cast<Index>(joint)];
    if (place < 0) continue;
    damage[edge] = damage_at(static_cast<Index>(place));
  }
  return damage;
}

// Of a followed joint, by its place: the mean of its points.
template <class Real>
float Fdem<Real>::damage_at(Index place) const {
  return static_cast<float>(Real(0.5) * (state_.damage[in_block(place, 2, 0)] + state_.damage[in_block(place, 2, 1)]));
}

template <class Real>
void Fdem<Real>::take_damage_changes(std::vector<EdgeDamage>& changes) const {
  for (Index b = 0; b < scratch_.grew.size(); ++b) {
    for (unsigned grew = std::exchange(scratch_.grew[b], 0); grew != 0; grew &= grew - 1) {
      const Index place = b * lanes + static_cast<Index>(std::countr_zero(grew));
      const int joint = scratch_.followed.joint_at[place];
      if (joint >= 0) changes.push_back({static_cast<std::uint32_t>(plan_.edge_of[static_cast<Index>(joint)]), damage_at(place)});
    }
  }
}

template <class Real>
void Fdem<Real>::save(ArchiveWriter& archive) const {
  const State<Real>& s = state_;
  for (const Field<Real>* field : {&s.u, &s.v, &s.slots, &s.plastic, &s.extra}) archive.put_array(*field);
  archive.put_array(s.followed), archive.put(s.settled);
  for (const Field<Real>* field : {&s.damage, &s.opening, &s.force}) archive.put_array(*field);
  archive.put_array(s.break_time), archive.put_array(s.break_mode);
  archive.put_array(s.exposed), archive.put(s.cracks_exposed);
  archive.put(s.ledger);
  contact_.save(archive);
}

template <class Real>
bool Fdem<Real>::load(ArchiveReader& archive, long long n, double dt) {
  State<Real>& s = state_;
  const auto clock = scratch_.clock;
  s = make_state(plan_, model_, body_), scratch_ = make_scratch(plan_, model_, body_);
  scratch_.clock = clock;
  for (Field<Real>* field : {&s.u, &s.v, &s.slots, &s.plastic, &s.extra}) archive.get_array_like(*field);
  std::vector<int> followed;
  archive.get_array(followed);
  const int settled = archive.get<int>();
  if (archive.failed() || !follow_again(plan_, s, scratch_, followed, settled)) return false;
  for (Field<Real>* field : {&s.damage, &s.opening, &s.force}) archive.get_array_like(*field);
  set_kept(s, scratch_, curve_of(settings_));
  archive.get_array_like(s.break_time), archive.get_array_like(s.break_mode);
  archive.get_array(s.exposed), s.cracks_exposed = archive.get<unsigned char>();
  s.ledger = archive.get<Ledger>();
  if (archive.failed() || !sides_exist(s.exposed, plan_)) return false;
  contact_.load(archive);
  if (archive.failed()) return false;
  for (const int side : s.exposed) watch_side(side);
  dt_ = dt;
  put_rows();
  tell_velocities((static_cast<double>(n) + 0.5) * dt);
  return true;
}

template <class Real>
double Fdem<Real>::stable_dt() const {
  if (stable_dt_ == 0.0) stable_dt_ = stable_step(plan_);
  return stable_dt_;
}

template <class Real>
std::map<std::string, double> Fdem<Real>::stage_seconds() const {
  std::map<std::string, double> seconds;
  for (Index i = 0; i < stage_names.size(); ++i) seconds[stage_names[i]] = scratch_.clock.seconds()[i];
  return seconds;
}

template <class Real>
std::string Fdem<Real>::kernel() const {
  return std::string(kernels_.isa) + (sizeof(Real) == sizeof(double) ? "/double" : "/float");
}

template class Fdem<double>;
template class Fdem<float>;

}  // namespace fracfarm::fdem
