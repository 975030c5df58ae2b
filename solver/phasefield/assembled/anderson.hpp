// Anderson's acceleration of the staggered passes (Anderson, 1965): the next damage to try is the mixture of the last passes' results whose
// changes cancel best. It changes how many passes a step takes, not what they converge to.
#pragma once

#include <Eigen/Core>
#include <deque>

namespace fracfarm::phasefield::assembled {

class Anderson {
 public:
  // `tried` gave `found`; what to try next.
  Eigen::VectorXd next(const Eigen::VectorXd& tried, const Eigen::VectorXd& found);

 private:
  Eigen::VectorXd last_change_, last_found_;
  std::deque<Eigen::VectorXd> changes_, founds_;  // differences from pass to pass
};

}  // namespace fracfarm::phasefield::assembled
