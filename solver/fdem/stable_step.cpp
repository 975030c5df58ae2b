// Locally optimal conjugate gradients for the top of dt^2 K + 2 dt C (Knyazev, 2001), with dt moved along: deterministic, from a start that
// lies where triangles are stiffest for their mass.
#include "solver/fdem/stable_step.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "common/base/random.hpp"
#include "solver/fdem/stiff_part.hpp"

namespace fracfarm::fdem {
namespace {

using Vector = Eigen::VectorXd;

// A vector with what both operators make of it.
struct Image {
  Vector y, K, C;
};

// dt at which dt^2 k + 2 dt c = 4.
double edge(double k, double c) { return 4.0 / (c + std::sqrt(c * c + 4.0 * k)); }

Vector start_vector(const StiffPart& part) {
  const Vector& rate = part.rate();
  const double most = rate.maxCoeff();
  RandomStream random(1, 0, 0);
  Vector y(rate.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = std::pow(rate[i] / most, 8.0) * random.uniform(-0.5, 0.5);
  part.project(y);
  return y.normalized();
}

// The best vector in the span of a few: the top of their small problem in A = K + (2 / dt) C.
Image best(const std::vector<Image*>& basis, double dt, Vector& weights) {
  const Eigen::Index count = static_cast<Eigen::Index>(basis.size());
  Eigen::MatrixXd A(count, count), M(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Image &p = *basis[static_cast<std::size_t>(i)], &q = *basis[static_cast<std::size_t>(j)];
      A(i, j) = p.y.dot(q.K) + (2.0 / dt) * p.y.dot(q.C), M(i, j) = p.y.dot(q.y);
    }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (A + A.transpose()), M);
  weights = solver.eigenvectors().col(count - 1);
  Image top{Vector::Zero(basis[0]->y.size()), Vector::Zero(basis[0]->y.size()), Vector::Zero(basis[0]->y.size())};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Image& p = *basis[static_cast<std::size_t>(i)];
    top.y += weights[i] * p.y, top.K += weights[i] * p.K, top.C += weights[i] * p.C;
  }
  return top;
}

constexpr int most_triangles = 1000, most_iterations = 60;
constexpr double tolerance = 2e-4;  // of dt, from one iteration to the next, three times in a row

}  // namespace

double stable_step(const Plan& plan) {
  StiffPart part(plan, most_triangles);
  Image x{start_vector(part), {}, {}}, direction, residual;
  part.apply(x.y, x.K, x.C);
  double dt = edge(x.y.dot(x.K), x.y.dot(x.C));
  int quiet = 0;
  for (int i = 0; i < most_iterations && quiet < 3; ++i) {
    const double value = x.y.dot(x.K) + (2.0 / dt) * x.y.dot(x.C);
    residual.y = x.K + (2.0 / dt) * x.C - value * x.y;
    const double size = residual.y.norm();
    if (!(size > 1e-10 * value)) break;
    residual.y /= size;
    part.apply(residual.y, residual.K, residual.C);
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
