#include "solver/phasefield/assembled/anderson.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using fracfarm::phasefield::assembled::Anderson;

namespace {

// A fixed-point map whose plain iteration shrinks the error by 0.98 and 0.5 to 0.9 in other directions.
Eigen::VectorXd mapped(const Eigen::VectorXd& x) {
  Eigen::VectorXd rates(6), target(6);
  rates << 0.98, 0.9, 0.8, 0.7, 0.6, 0.5;
  target << 1.0, -2.0, 3.0, 0.5, 0.1, 4.0;
  return target + rates.cwiseProduct(x - target);
}

int passes(bool accelerated) {
  Anderson anderson;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
  for (int pass = 1; pass < 5000; ++pass) {
    const Eigen::VectorXd found = mapped(x);
    if ((found - x).cwiseAbs().maxCoeff() < 1e-9) return pass;
    x = accelerated ? anderson.next(x, found) : found;
  }
  return 5000;
}

}  // namespace

TEST_CASE("a slow contraction ends at the same place in far fewer accelerated passes") {
  CHECK(passes(false) > 500);
  CHECK(passes(true) < 60);
}

TEST_CASE("the first pass and one after a jump go on from what was found") {
  Anderson anderson;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3), one = Eigen::VectorXd::Ones(3);
  CHECK(anderson.next(zero, one) == one);
  CHECK(anderson.next(one, 3.0 * one) == 3.0 * one);  // the change grew
}

TEST_CASE("where nothing changes any more the result is what was found") {
  Anderson anderson;
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(3);
  for (int k = 0; k < 4; ++k) CHECK((anderson.next(one, one) - one).norm() == 0.0);
}
