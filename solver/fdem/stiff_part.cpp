#include "solver/fdem/stiff_part.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

double shape_of(const Plan& plan, int slot, int i) {
  return plan.shape[static_cast<Index>(((slot / lanes) * shape_count + i) * lanes + slot % lanes)];
}

const TriangleLaw<double>& law_of(const Plan& plan, int slot) {
  return plan.laws[static_cast<Index>(plan.law_of_block[static_cast<Index>(slot / lanes)])];
}

double spring_of(const Plan& plan, int joint) {
  const double p = plan.joint_laws[static_cast<Index>(plan.joint_law_of_block[static_cast<Index>(joint / lanes)])].penalty;
  return p * plan.length[static_cast<Index>(joint)] / 6.0;
}

// By slot, 1/s^2: of the triangle's own stiffness and its joints' over a corner's mass.
std::vector<double> local_rates(const Plan& plan) {
  std::vector<double> spring(static_cast<Index>(plan.slots) + 2, 0.0), rates(static_cast<Index>(plan.slots));
  for (int joint = 0; joint < plan.joints; ++joint)
    for (const int side : {plan.left_side[static_cast<Index>(joint)], plan.right_side[static_cast<Index>(joint)]})
      spring[static_cast<Index>(side / 3)] += 6.0 * spring_of(plan, joint);
  for (int slot = 0; slot < plan.slots; ++slot) {
    const auto B = [&](int i) { return shape_of(plan, slot, i); };
    const double square = B(0) * B(0) + B(1) * B(1) + B(2) * B(2) + B(3) * B(3);
    const double own = law_of(plan, slot).stiffness.C11 * square * B(4);
    rates[static_cast<Index>(slot)] = (own + spring[static_cast<Index>(slot)]) * B(5);
  }
  return rates;
}

std::vector<int> quickest(const Plan& plan, const std::vector<double>& rates, int most) {
  std::vector<int> slots;
  for (int slot = 0; slot < plan.slots; ++slot)
    if (rates[static_cast<Index>(slot)] > 0.0) slots.push_back(slot);
  if (!plan.ties.empty() || static_cast<int>(slots.size()) <= most) return slots;
  const auto quicker = [&](int s, int t) {
    return std::pair(rates[static_cast<Index>(t)], s) < std::pair(rates[static_cast<Index>(s)], t);
  };
  std::nth_element(slots.begin(), slots.begin() + most, slots.end(), quicker);
  slots.resize(static_cast<Index>(most));
  for (int slot : std::vector<int>(slots))
    for (int k = 0; k < 3; ++k)
      if (const int side = plan.neighbour[static_cast<Index>(3 * slot + k)]; side >= 0) slots.push_back(side / 3);
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

}  // namespace

StiffPart::StiffPart(const Plan& plan, int most) {
  const std::vector<double> rates = local_rates(plan);
  const std::vector<int> slots = quickest(plan, rates, most);
  std::vector<int> place(static_cast<Index>(plan.slots) + 2, -1);
  for (Index i = 0; i < slots.size(); ++i) place[static_cast<Index>(slots[i])] = static_cast<int>(i);
  per_root_.resize(static_cast<Eigen::Index>(6 * slots.size())), rate_.resize(per_root_.size());
  for (Index i = 0; i < slots.size(); ++i) {
    add_triangle(plan, slots[i]);
    per_root_.segment<6>(static_cast<Eigen::Index>(6 * i)).setConstant(std::sqrt(shape_of(plan, slots[i], 5)));
    rate_.segment<6>(static_cast<Eigen::Index>(6 * i)).setConstant(rates[static_cast<Index>(slots[i])]);
  }
  add_joints(plan, place);
  add_ties(plan, place);
  for (auto* numbers : {&u_, &k_, &c_}) numbers->assign(6 * slots.size() + 2, 0.0);
}

void StiffPart::add_triangle(const Plan& plan, int slot) {
  const auto B = [&](int i) { return shape_of(plan, slot, i); };
  triangles_.push_back({B(0), B(1), B(2), B(3), B(4), law_of(plan, slot).stiffness, law_of(plan, slot).viscosity});
}

void StiffPart::add_joints(const Plan& plan, const std::vector<int>& place) {
  const int held = static_cast<int>(size());
  const auto number = [&](int corner) {
    const int at = place[static_cast<Index>(corner / 3)];
    return at < 0 ? held : 6 * at + 2 * (corner % 3);
  };
  const auto next = [](int side) { return side - side % 3 + (side % 3 + 1) % 3; };
  for (int joint = 0; joint < plan.joints; ++joint) {
    if (plan.edge_of[static_cast<Index>(joint)] < 0) continue;
    const int left = plan.left_side[static_cast<Index>(joint)], right = plan.right_side[static_cast<Index>(joint)];
    const Joint added{number(left), number(next(left)), number(next(right)), number(right), spring_of(plan, joint)};
    if (added.la < held || added.ra < held) joints_.push_back(added);
  }
}

void StiffPart::add_ties(const Plan& plan, const std::vector<int>& place) {
  for (const auto& group : plan.ties) {
    double mass = 0.0;
    for (const int corner : group) mass += corner_mass(plan, corner);
    ties_.emplace_back();
    for (const int corner : group) {
      ties_.back().push_back(6 * place[static_cast<Index>(corner / 3)] + 2 * (corner % 3));
      tie_share_.push_back(std::sqrt(corner_mass(plan, corner) / mass));
    }
  }
}

void StiffPart::apply(const Eigen::VectorXd& y, Eigen::VectorXd& stiff, Eigen::VectorXd& viscous) {
  const Eigen::Index n = size();
  Eigen::Map<Eigen::VectorXd>(u_.data(), n) = per_root_.cwiseProduct(y);
  std::fill(k_.begin(), k_.end(), 0.0);
  double *k = k_.data(), *c = c_.data();
  const double* u = u_.data();
  for (const Joint& j : joints_)
    for (int axis = 0; axis < 2; ++axis) {
      const double a = u[j.ra + axis] - u[j.la + axis], b = u[j.rb + axis] - u[j.lb + axis];
      const double fa = j.spring * (2.0 * a + b), fb = j.spring * (a + 2.0 * b);
      k[j.la + axis] -= fa, k[j.lb + axis] -= fb, k[j.ra + axis] += fa, k[j.rb + axis] += fb;
    }
  for (const Triangle& t : triangles_) {
    const double x1 = u[2] - u[0], x2 = u[4] - u[0], z1 = u[3] - u[1], z2 = u[5] - u[1];
    const double xx = x1 * t.b11 + x2 * t.b21, xz = x1 * t.b12 + x2 * t.b22, zx = z1 * t.b11 + z2 * t.b21, zz = z1 * t.b12 + z2 * t.b22;
    const auto f = [&](const law::Stress<double>& s, double* at, double keep) {
      const double fx1 = t.area * (s.xx * t.b11 + s.xz * t.b12), fz1 = t.area * (s.xz * t.b11 + s.zz * t.b12);
      const double fx2 = t.area * (s.xx * t.b21 + s.xz * t.b22), fz2 = t.area * (s.xz * t.b21 + s.zz * t.b22);
      at[0] = keep * at[0] - (fx1 + fx2), at[1] = keep * at[1] - (fz1 + fz2);
      at[2] = keep * at[2] + fx1, at[3] = keep * at[3] + fz1, at[4] = keep * at[4] + fx2, at[5] = keep * at[5] + fz2;
    };
    f(law::stress(t.C, {xx, zz, xz + zx}), k, 1.0);
    f({t.viscosity * xx, t.viscosity * zz, 0.5 * t.viscosity * (xz + zx)}, c, 0.0);
    u += 6, k += 6, c += 6;
  }
  stiff = per_root_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(k_.data(), n));
  viscous = per_root_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(c_.data(), n));
  project(stiff), project(viscous);
}

void StiffPart::project(Eigen::VectorXd& y) const {
  Index at = 0;
  for (const auto& group : ties_) {
    for (int axis = 0; axis < 2; ++axis) {
      double sum = 0.0;
      for (Index i = 0; i < group.size(); ++i) sum += tie_share_[at + i] * y[group[i] + axis];
      for (Index i = 0; i < group.size(); ++i) y[group[i] + axis] = tie_share_[at + i] * sum;
    }
    at += group.size();
  }
}

}  // namespace fracfarm::fdem
