// What is done to a body from outside: told velocities, forces, tied corners, and the work and reactions of all of it.
#include "solver/fdem/solver.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

double outward(Side side) { return side == Side::right || side == Side::top ? 1.0 : -1.0; }

}  // namespace

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
  const double per_dt = 1.0 / dt;
  for (Index i = 0; i < model_.told_dofs.size(); ++i) {
    const ToldDof& dof = model_.told_dofs[i];
    const double before = scratch_.told_before[i], after = scratch_.told_velocity[dof.at_told];
    const double force = dof.mass * (after - before) * per_dt - static_cast<double>(scratch_.told_force[dof.at_told]);
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

#define FRACFARM_INSTANTIATE(Real)                          \
  template void Fdem<Real>::tell_velocities(double);        \
  template void Fdem<Real>::pull(double);                   \
  template void Fdem<Real>::move_as_one(double);            \
  template void Fdem<Real>::remember_told() const;          \
  template Powers Fdem<Real>::power_of_told(double) const;  \
  template double Fdem<Real>::power_of_pulls(double) const; \
  template std::array<double, 4> Fdem<Real>::reactions(double) const;
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
