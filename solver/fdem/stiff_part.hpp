// The stiffest part of a body as linear operators: undamaged triangles and joints at rest, whose fastest oscillations are those of the
// whole body, because they hardly reach past the triangle that they start from.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/fdem/plan.hpp"

namespace fracfarm::fdem {

// Stiffness K and viscosity C with the mass split between both sides, M^-1/2 . M^-1/2, on the corners of the triangles that are quickest
// for their mass, and of their neighbours; all others are held, which can only make the largest eigenvalue smaller.
class StiffPart {
 public:
  // `most`: triangles before their neighbours join; bodies with tied corners are taken whole.
  StiffPart(const Plan& plan, int most);

  Eigen::Index size() const { return per_root_.size(); }
  void apply(const Eigen::VectorXd& y, Eigen::VectorXd& stiff, Eigen::VectorXd& viscous);
  // Tied corners move as one.
  void project(Eigen::VectorXd& y) const;
  // By number of the vectors: stiffness of the triangle and its joints over its mass, 1/s^2, up to a factor.
  const Eigen::VectorXd& rate() const { return rate_; }

 private:
  struct Triangle {
    double b11, b12, b21, b22, area;
    law::Stiffness<double> C;
    double viscosity;
  };
  struct Joint {
    int la, lb, ra, rb;  // first of the two numbers of each end; size() where it is held
    double spring;       // p L / 6
  };
  void add_triangle(const Plan& plan, int slot);
  void add_joints(const Plan& plan, const std::vector<int>& place);
  void add_ties(const Plan& plan, const std::vector<int>& place);

  std::vector<Triangle> triangles_;
  std::vector<Joint> joints_;
  std::vector<std::vector<int>> ties_;
  std::vector<double> tie_share_;
  Eigen::VectorXd per_root_, rate_;
  std::vector<double> u_, k_, c_;  // with two numbers behind the last for what is held
};

}  // namespace fracfarm::fdem
