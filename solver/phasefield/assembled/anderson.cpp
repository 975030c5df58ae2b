#include "solver/phasefield/assembled/anderson.hpp"

#include <Eigen/QR>

namespace fracfarm::phasefield::assembled {
namespace {

constexpr std::size_t depth = 5;
constexpr double grown = 1.5;  // changes that grow by more than this are a crack that runs: no mixture of old passes foretells it

}  // namespace

Eigen::VectorXd Anderson::next(const Eigen::VectorXd& tried, const Eigen::VectorXd& found) {
  const Eigen::VectorXd change = found - tried;
  if (last_change_.size() > 0 && change.norm() > grown * last_change_.norm()) {
    changes_.clear(), founds_.clear();
  } else if (last_change_.size() > 0) {
    changes_.push_back(change - last_change_), founds_.push_back(found - last_found_);
    if (changes_.size() > depth) changes_.pop_front(), founds_.pop_front();
  }
  last_change_ = change, last_found_ = found;
  if (changes_.empty()) return found;
  Eigen::MatrixXd differences(change.size(), static_cast<Eigen::Index>(changes_.size()));
  for (std::size_t k = 0; k < changes_.size(); ++k) differences.col(static_cast<Eigen::Index>(k)) = changes_[k];
  const Eigen::VectorXd shares = differences.colPivHouseholderQr().solve(change);
  Eigen::VectorXd mixed = found;
  for (std::size_t k = 0; k < founds_.size(); ++k) mixed -= shares[static_cast<Eigen::Index>(k)] * founds_[k];
  return mixed;
}

}  // namespace fracfarm::phasefield::assembled
