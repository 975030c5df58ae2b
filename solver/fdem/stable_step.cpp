// Locally optimal conjugate gradients for the top of dt^2 K + 2 dt C (Knyazev, 2001), with dt moved along: deterministic, from a start that
// lies where triangles are stiffest for their mass.
#include "solver/fdem/stable_step.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "common/base/random.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;
using Vector = Eigen::VectorXd;

// Both operators, with the mass split between both sides: M^-1/2 . M^-1/2. Numbers by corner: 2 (3 slot + k) + axis.
class Operators {
 public:
  explicit Operators(const Plan& plan) : plan_(plan), per_root_(6 * plan.slots) {
    for (int corner = 0; corner < 3 * plan.slots; ++corner) {
      const double m = corner_mass(plan, corner);
      per_root_[2 * corner] = per_root_[2 * corner + 1] = m > 0.0 ? 1.0 / std::sqrt(m) : 0.0;
    }
    for (const auto& group : plan.ties) {
      double mass = 0.0;
      for (const int corner : group) mass += corner_mass(plan, corner);
      for (const int corner : group) tie_share_.push_back(std::sqrt(corner_mass(plan, corner) / mass));
    }
  }

  Eigen::Index size() const { return per_root_.size(); }

  void apply(const Vector& y, Vector& stiff, Vector& viscous) {
    u_ = per_root_.cwiseProduct(y);
    stiff.setZero(size()), viscous.setZero(size());
    for (int slot = 0; slot < plan_.slots; ++slot) add_triangle(slot, stiff, viscous);
    for (int joint = 0; joint < plan_.joints; ++joint) add_joint(joint, stiff);
    stiff.array() *= per_root_.array(), viscous.array() *= per_root_.array();
    project(stiff), project(viscous);
  }

  // Tied corners move as one.
  void project(Vector& y) const {
    Index at = 0;
    for (const auto& group : plan_.ties) {
      for (int axis = 0; axis < 2; ++axis) {
        double sum = 0.0;
        for (Index i = 0; i < group.size(); ++i) sum += tie_share_[at + i] * y[2 * group[i] + axis];
        for (Index i = 0; i < group.size(); ++i) y[2 * group[i] + axis] = tie_share_[at + i] * sum;
      }
      at += group.size();
    }
  }

  // Largest by corner, up to a factor: stiffness of the triangle and its joints over its mass.
  Vector stiffest() const {
    std::vector<double> spring(static_cast<Index>(plan_.slots) + 2, 0.0);
    for (int joint = 0; joint < plan_.joints; ++joint) {
      const double p = joint_law(joint).penalty * plan_.length[static_cast<Index>(joint)];
      spring[static_cast<Index>(plan_.left_side[static_cast<Index>(joint)] / 3)] += p;
      spring[static_cast<Index>(plan_.right_side[static_cast<Index>(joint)] / 3)] += p;
    }
    Vector rate(size());
    for (int slot = 0; slot < plan_.slots; ++slot) {
      const auto B = shape(slot);
      const double own = law(slot).stiffness.C11 * (B[0] * B[0] + B[1] * B[1] + B[2] * B[2] + B[3] * B[3]) * B[4];
      for (int i = 0; i < 6; ++i) rate[6 * slot + i] = (own + spring[static_cast<Index>(slot)]) * B[5];
    }
    return rate;
  }

 private:
  std::array<double, shape_count> shape(int slot) const {
    std::array<double, shape_count> values;
    for (int i = 0; i < shape_count; ++i)
      values[static_cast<Index>(i)] = plan_.shape[static_cast<Index>(((slot / lanes) * shape_count + i) * lanes + slot % lanes)];
    return values;
  }
  const TriangleLaw<double>& law(int slot) const {
    return plan_.laws[static_cast<Index>(plan_.law_of_block[static_cast<Index>(slot / lanes)])];
  }
  const law::Joint<double>& joint_law(int joint) const {
    return plan_.joint_laws[static_cast<Index>(plan_.joint_law_of_block[static_cast<Index>(joint / lanes)])];
  }

  void add_triangle(int slot, Vector& stiff, Vector& viscous) const {
    const auto B = shape(slot);
    if (B[4] == 0.0) return;
    const double* u = &u_[6 * slot];
    const double x1 = u[2] - u[0], x2 = u[4] - u[0], z1 = u[3] - u[1], z2 = u[5] - u[1];
    const double xx = x1 * B[0] + x2 * B[2], xz = x1 * B[1] + x2 * B[3], zx = z1 * B[0] + z2 * B[2], zz = z1 * B[1] + z2 * B[3];
    const TriangleLaw<double>& own = law(slot);
    const auto add = [&](double sxx, double szz, double sxz, Vector& f) {
      const double fx1 = B[4] * (sxx * B[0] + sxz * B[1]), fz1 = B[4] * (sxz * B[0] + szz * B[1]);
      const double fx2 = B[4] * (sxx * B[2] + sxz * B[3]), fz2 = B[4] * (sxz * B[2] + szz * B[3]);
      double* at = &f[6 * slot];
      at[0] -= fx1 + fx2, at[1] -= fz1 + fz2, at[2] += fx1, at[3] += fz1, at[4] += fx2, at[5] += fz2;
    };
    const law::Stress<double> s = law::stress(own.stiffness, {xx, zz, xz + zx});
    add(s.xx, s.zz, s.xz, stiff);
    add(own.viscosity * xx, own.viscosity * zz, 0.5 * own.viscosity * (xz + zx), viscous);
  }

  void add_joint(int joint, Vector& stiff) const {
    const Index j = static_cast<Index>(joint);
    if (plan_.edge_of[j] < 0) return;
    const int left = plan_.left_side[j], right = plan_.right_side[j];
    const double spring = joint_law(joint).penalty * plan_.length[j] / 6.0;
    const auto next = [](int side) { return side - side % 3 + (side % 3 + 1) % 3; };
    const int la = 2 * left, lb = 2 * next(left), ra = 2 * next(right), rb = 2 * right;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = u_[ra + axis] - u_[la + axis], b = u_[rb + axis] - u_[lb + axis];
      const double fa = spring * (2.0 * a + b), fb = spring * (a + 2.0 * b);
      stiff[la + axis] -= fa, stiff[lb + axis] -= fb, stiff[ra + axis] += fa, stiff[rb + axis] += fb;
    }
  }

  const Plan& plan_;
  Vector per_root_, u_;
  std::vector<double> tie_share_;
};

// A vector with what both operators make of it.
struct Image {
  Vector y, K, C;
};

// dt at which dt^2 k + 2 dt c = 4.
double edge(double k, double c) { return 4.0 / (c + std::sqrt(c * c + 4.0 * k)); }

Vector start_vector(const Operators& operators) {
  const Vector rate = operators.stiffest();
  const double most = rate.maxCoeff();
  RandomStream random(1, 0, 0);
  Vector y(rate.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = std::pow(rate[i] / most, 8.0) * random.uniform(-0.5, 0.5);
  operators.project(y);
  return y.normalized();
}

// The best vector in the span of a few: the top of their small problem in A = K + (2 / dt) C.
Image best(const std::vector<Image*>& basis, double dt, Vector& weights) {
  const Eigen::Index count = static_cast<Eigen::Index>(basis.size());
  Eigen::MatrixXd A(count, count), M(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Image &p = *basis[static_cast<Index>(i)], &q = *basis[static_cast<Index>(j)];
      A(i, j) = p.y.dot(q.K) + (2.0 / dt) * p.y.dot(q.C), M(i, j) = p.y.dot(q.y);
    }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (A + A.transpose()), M);
  weights = solver.eigenvectors().col(count - 1);
  Image top{Vector::Zero(basis[0]->y.size()), Vector::Zero(basis[0]->y.size()), Vector::Zero(basis[0]->y.size())};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Image& p = *basis[static_cast<Index>(i)];
    top.y += weights[i] * p.y, top.K += weights[i] * p.K, top.C += weights[i] * p.C;
  }
  return top;
}

constexpr int most_iterations = 60;
constexpr double tolerance = 2e-4;  // of dt, from one iteration to the next, three times in a row

}  // namespace

double stable_step(const Plan& plan) {
  Operators operators(plan);
  Image x{start_vector(operators), {}, {}}, direction, residual;
  operators.apply(x.y, x.K, x.C);
  double dt = edge(x.y.dot(x.K), x.y.dot(x.C));
  int quiet = 0;
  for (int i = 0; i < most_iterations && quiet < 3; ++i) {
    const double value = x.y.dot(x.K) + (2.0 / dt) * x.y.dot(x.C);
    residual.y = x.K + (2.0 / dt) * x.C - value * x.y;
    const double size = residual.y.norm();
    if (!(size > 1e-10 * value)) break;
    residual.y /= size;
    operators.apply(residual.y, residual.K, residual.C);
    std::vector<Image*> basis{&x, &residual};
    if (i > 0) basis.push_back(&direction);
    Vector weights;
    Image next = best(basis, dt, weights);
    direction = next;
    direction.y -= weights[0] * x.y, direction.K -= weights[0] * x.K, direction.C -= weights[0] * x.C;
    const double scale = 1.0 / direction.y.norm(), length = 1.0 / next.y.norm();
    direction.y *= scale, direction.K *= scale, direction.C *= scale;
    next.y *= length, next.K *= length, next.C *= length;
    x = std::move(next);
    const double now = edge(x.y.dot(x.K), x.y.dot(x.C));
    quiet = std::abs(now - dt) < tolerance * dt ? quiet + 1 : 0;
    dt = now;
  }
  return dt;
}

}  // namespace fracfarm::fdem
