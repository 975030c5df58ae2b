#include "solver/fdem/solver.hpp"

#include <algorithm>
#include <cmath>

#include "solver/fdem/materials.hpp"
#include "solver/fdem/stable_step.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

constexpr int chunk_blocks = 64;

double outward(Side side) { return side == Side::right || side == Side::top ? 1.0 : -1.0; }

// job(chunk, blocks) over all blocks in chunks; the sums come back in the order of the chunks.
template <class Sums, class Job>
std::vector<Sums> in_chunks(int blocks, int threads, const Job& job) {
  const int chunks = (blocks + chunk_blocks - 1) / chunk_blocks;
  std::vector<Sums> sums(static_cast<Index>(chunks));
#pragma omp parallel for num_threads(threads) schedule(static) if (threads > 1)
  for (int chunk = 0; chunk < chunks; ++chunk)
    sums[static_cast<Index>(chunk)] = job(Blocks{chunk * chunk_blocks, std::min(blocks, (chunk + 1) * chunk_blocks)});
  return sums;
}

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
  v.left_slot = plan_.left_slot.data(), v.right_slot = plan_.right_slot.data();
  v.left_row = plan_.left_row.data(), v.right_row = plan_.right_row.data();
  v.length = model_.length.data(), v.along = model_.along.data();
  v.damage = s.damage.data(), v.opening = s.opening.data(), v.joint_state = s.joint_state.data();
  v.joint_laws = model_.joint_laws.data(), v.joint_law_of_block = plan_.joint_law_of_block.data();
  v.curve = curve_of(settings_);
  v.always_follow = !rules_.damage_where_stretched, v.always_flow = !rules_.flow_where_it_yields;
  return v;
}

template <class Real>
AdvanceSums Fdem<Real>::advance(double dt) {
  const View<Real> v = view();
  AdvanceSums all{};
  for (const AdvanceSums& part : in_chunks<AdvanceSums>(plan_.triangle_blocks(), threads_,
                                                        [&](Blocks blocks) { return kernels_.advance(v, blocks, static_cast<Real>(dt)); }))
    all.viscous += part.viscous, all.plastic += part.plastic;
  return all;
}

template <class Real>
TriangleSums Fdem<Real>::measure(double dt) const {
  const View<Real> v = view();
  TriangleSums all{};
  for (const TriangleSums& part : in_chunks<TriangleSums>(
           plan_.triangle_blocks(), threads_, [&](Blocks blocks) { return kernels_.measure(v, blocks, static_cast<Real>(dt)); })) {
    all.stress_xx += part.stress_xx, all.stress_zz += part.stress_zz, all.elastic += part.elastic, all.plastic += part.plastic;
    all.viscous += part.viscous, all.kinetic += part.kinetic, all.fastest = std::max(all.fastest, part.fastest);
  }
  return all;
}

template <class Real>
void Fdem<Real>::join(double time) {
  const View<Real> v = view();
  state_.ledger.joints_stored = 0.0;
  for (const JointSums& part :
       in_chunks<JointSums>(plan_.joint_blocks(), threads_, [&](Blocks blocks) { return kernels_.join(v, blocks); }))
    state_.ledger.joints_stored += part.stored, state_.ledger.fracture += part.fracture;
  note_breaks(time);
}

template <class Real>
void Fdem<Real>::note_breaks(double time) {
  for (int b = 0; b < plan_.joint_blocks(); ++b) {
    if (!(state_.joint_state[static_cast<Index>(b)] & joint_broke)) continue;
    for (int l = 0; l < lanes; ++l) {
      const Index at = static_cast<Index>(b) * 2 * lanes + static_cast<Index>(l);
      const int edge = plan_.edge_of[static_cast<Index>(b * lanes + l)];
      if (edge < 0 || state_.damage[at] < Real(1) || state_.damage[at + lanes] < Real(1)) continue;
      double& broke = state_.break_time[static_cast<Index>(edge)];
      if (!std::isnan(broke)) continue;
      broke = time, state_.break_mode[static_cast<Index>(edge)] = static_cast<unsigned char>(mode_of(b, l));
      expose(plan_.left_side[static_cast<Index>(b * lanes + l)]), expose(plan_.right_side[static_cast<Index>(b * lanes + l)]);
    }
  }
}

template <class Real>
void Fdem<Real>::expose(int side) {
  contact_.expose(side);
  state_.exposed.push_back(side);
  watch_side(side);
}

// Forces of contact come in by the triangle's row of `extra`.
template <class Real>
void Fdem<Real>::watch_side(int side) {
  const int slot = side / 3;
  scratch_.needs[static_cast<Index>(slot / lanes)] |= needs_extra;
  scratch_.extra_slots.push_back(slot);
}

// The faces of initial cracks, once two of them overlap: before, contact has nothing to do.
template <class Real>
void Fdem<Real>::expose_cracks_that_close() {
  if (state_.cracks_exposed || (rules_.contact_after_break && !a_crack_closes())) return;
  state_.cracks_exposed = 1;
  for (const int side : plan_.crack_sides) expose(side);
}

template <class Real>
bool Fdem<Real>::a_crack_closes() const {
  for (Index i = 0; i + 1 < plan_.crack_sides.size(); i += 2) {
    const int row = row_of_side(plan_.crack_sides[i]);
    const Real *left = &scratch_.rows[static_cast<Index>(row)],
               *right = &scratch_.rows[static_cast<Index>(row_of_side(plan_.crack_sides[i + 1]))];
    const double* corners = &plan_.corner_rows[static_cast<Index>(row)];
    const Real x = static_cast<Real>(corners[2] - corners[0]), z = static_cast<Real>(corners[3] - corners[1]);
    if ((right[2] - left[0]) * z < (right[3] - left[1]) * x || (right[0] - left[2]) * z < (right[1] - left[3]) * x) return true;
  }
  return false;
}

// By the shares of opening and sliding, each of what breaks the joint alone, in their squares: three quarters of one name it.
template <class Real>
BreakMode Fdem<Real>::mode_of(int b, int l) const {
  const Index joint = static_cast<Index>(b * lanes + l), line = static_cast<Index>(b) * 2 * lanes + static_cast<Index>(l);
  const Real *left = &scratch_.rows[static_cast<Index>(plan_.left_row[joint])],
             *right = &scratch_.rows[static_cast<Index>(plan_.right_row[joint])];
  double x = plan_.along[line], z = plan_.along[line + lanes];
  x += 0.5 * ((double(left[2]) - left[0]) + (double(right[0]) - right[2]));
  z += 0.5 * ((double(left[3]) - left[1]) + (double(right[1]) - right[3]));
  const double ends[2][2] = {{double(right[2]) - left[0], double(right[3]) - left[1]},
                             {double(right[0]) - left[2], double(right[1]) - left[3]}};
  const auto& law = plan_.joint_laws[static_cast<Index>(plan_.joint_law_of_block[static_cast<Index>(b)])];
  double opens = 0.0, slides = 0.0;
  for (const auto& [dx, dz] : ends) {
    const double n = std::max(0.0, dx * z - dz * x) * law.per_rupture_n, t = (dx * x + dz * z) * law.per_rupture_t;
    opens += n * n, slides += t * t;
  }
  const double share = opens / std::max(opens + slides, 1e-300);
  return share >= 0.75 ? BreakMode::tension : share <= 0.25 ? BreakMode::shear : BreakMode::mixed;
}

template <class Real>
void Fdem<Real>::put_rows() {
  for (int slot = 0; slot < plan_.slots; ++slot)
    for (int k = 0; k < 4; ++k)
      for (int axis = 0; axis < 2; ++axis)
        scratch_.rows[static_cast<Index>(slot * row_size + 2 * k + axis)] = state_.u[at_corner(3 * slot + k % 3, axis)];
}

template <class Real>
void Fdem<Real>::tell_velocities(double time) {
  std::vector<Real> velocity;
  for (const Told& told : body_.told) velocity.push_back(static_cast<Real>(told.velocity(time)));
  for (const ToldDof& dof : model_.told_dofs) scratch_.told_velocity[dof.at_told] = velocity[static_cast<Index>(dof.motion)];
}

template <class Real>
void Fdem<Real>::pull(double time) {
  for (const int slot : scratch_.extra_slots) std::fill_n(&state_.extra[static_cast<Index>(slot) * row_size], row_size, Real(0));
  std::vector<double> share;
  for (const Pull& pull : body_.pulls) share.push_back(pull.share(time));
  for (const PulledCorner& pulled : model_.pulled) {
    const double grown = pulled.pull < 0 ? 1.0 : share[static_cast<Index>(pulled.pull)];
    state_.extra[in_row(pulled.corner, 0)] += static_cast<Real>(grown * pulled.fx);
    state_.extra[in_row(pulled.corner, 1)] += static_cast<Real>(grown * pulled.fz);
  }
}

// Corners that are tied together get the velocity of their common momentum, which is that of one node with all their masses and forces.
template <class Real>
void Fdem<Real>::move_as_one(double dt) {
  for (const auto& group : plan_.ties)
    for (int axis = 0; axis < 2; ++axis) {
      double mass = 0.0, momentum = 0.0;
      for (const int corner : group) {
        const double m = corner_mass(plan_, corner);
        mass += m, momentum += m * static_cast<double>(state_.v[at_corner(corner, axis)]);
      }
      const Real together = static_cast<Real>(momentum / mass), own = state_.v[at_corner(group.front(), axis)];
      const Real u = state_.u[at_corner(group.front(), axis)] + static_cast<Real>(dt) * (together - own);
      for (const int corner : group) {
        state_.v[at_corner(corner, axis)] = together, state_.u[at_corner(corner, axis)] = u;
        scratch_.rows[in_row(corner, axis)] = u;
        if (corner % 3 == 0) scratch_.rows[in_row(corner, axis) + 6] = u;
      }
    }
}

template <class Real>
void Fdem<Real>::remember_told() const {
  for (Index i = 0; i < model_.told_dofs.size(); ++i) scratch_.told_before[i] = static_cast<double>(state_.v[model_.told_dofs[i].at]);
}

// What held nodes get from outside at an instant is R = m (v+ - v-) / dt - f, with v- and v+ half a step before and after. Its share of the
// work of the step before is dt/2 v- R, of the step after dt/2 v+ R: with 1/2 m v- v+ as kinetic energy the ledger closes exactly.
template <class Real>
Powers Fdem<Real>::power_of_told(double dt) const {
  Powers powers{};
  for (Index i = 0; i < model_.told_dofs.size(); ++i) {
    const ToldDof& dof = model_.told_dofs[i];
    const double before = scratch_.told_before[i], after = scratch_.told_velocity[dof.at_told];
    const double force = dof.mass * (after - before) / dt - static_cast<double>(scratch_.told_force[dof.at_told]);
    powers.before += force * before, powers.after += force * after;
  }
  return powers;
}

template <class Real>
double Fdem<Real>::power_of_pulls(double time) const {
  double power = 0.0;
  for (const PulledCorner& p : model_.pulled) {
    const double grown = p.pull < 0 ? 1.0 : body_.pulls[static_cast<Index>(p.pull)].share(time);
    power += grown *
             (p.fx * static_cast<double>(state_.v[at_corner(p.corner, 0)]) + p.fz * static_cast<double>(state_.v[at_corner(p.corner, 1)]));
  }
  return power;
}

template <class Real>
std::array<double, 4> Fdem<Real>::reactions(double dt) const {
  std::array<double, 4> sums{};
  for (Index i = 0; i < model_.told_dofs.size(); ++i) {
    const ToldDof& dof = model_.told_dofs[i];
    const auto& side = body_.told[static_cast<Index>(dof.motion)].side;
    if (!side) continue;
    const double change = scratch_.told_velocity[dof.at_told] - scratch_.told_before[i];
    sums[static_cast<Index>(*side)] += outward(*side) * (dof.mass * change / dt - static_cast<double>(scratch_.told_force[dof.at_told]));
  }
  for (Index side = 0; side < 4; ++side) sums[side] = body_.side_length[side] > 0.0 ? sums[side] / body_.side_length[side] : 0.0;
  return sums;
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
  put_rows();
  join(0.0);
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
  state_.ledger.initial_energy = sums.kinetic + sums.elastic + state_.ledger.joints_stored - given;
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
  const AdvanceSums moved = advance(dt);
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
  join(next);
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
  row.kinetic_energy = sums.kinetic;
  row.elastic_energy = sums.elastic + ledger.joints_stored;
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
    const Index at = static_cast<Index>((joint / lanes) * 2 * lanes + joint % lanes);
    damage[edge] = static_cast<float>(Real(0.5) * (state_.damage[at] + state_.damage[at + lanes]));
  }
  return damage;
}

template <class Real>
void Fdem<Real>::save(ArchiveWriter& archive) const {
  const State<Real>& s = state_;
  for (const Field<Real>* field : {&s.u, &s.v, &s.slots, &s.plastic, &s.damage, &s.opening, &s.extra}) archive.put_array(*field);
  archive.put_array(s.joint_state), archive.put_array(s.break_time), archive.put_array(s.break_mode);
  archive.put_array(s.exposed), archive.put(s.cracks_exposed);
  archive.put(s.ledger);
  contact_.save(archive);
}

template <class Real>
bool Fdem<Real>::load(ArchiveReader& archive, long long n, double dt) {
  State<Real>& s = state_;
  for (Field<Real>* field : {&s.u, &s.v, &s.slots, &s.plastic, &s.damage, &s.opening, &s.extra}) archive.get_array_like(*field);
  archive.get_array_like(s.joint_state), archive.get_array_like(s.break_time), archive.get_array_like(s.break_mode);
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
