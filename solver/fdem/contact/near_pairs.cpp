#include "solver/fdem/contact/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fracfarm::fdem {
namespace {

double larger(double a, double b) { return a > b ? a : b; }

// Largest change of a coordinate; no number if one of them is none.
double change(const SideNow& a, const SideNow& b) {
  return larger(larger(std::abs(a.ax - b.ax), std::abs(a.az - b.az)), larger(std::abs(a.bx - b.bx), std::abs(a.bz - b.bz)));
}

// A corner whose coordinates changed by `most` at most has moved this far at most; within `margin`?
bool within(double most, double margin) { return 4.0 * std::numbers::sqrt2 * most <= margin; }

}  // namespace

// Where the known sides are now, and the largest change of a coordinate since the near list was made.
template <class Real>
double NearPairs::move(const std::vector<ExposedSide>& sides, const Real* displacement) {
  double most = 0.0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const ExposedSide& side = sides[i];
    const Real* u = displacement + side.row;
    now_[i] = {side.x0 + static_cast<double>(u[0]), side.z0 + static_cast<double>(u[1]), side.x1 + static_cast<double>(u[2]),
               side.z1 + static_cast<double>(u[3])};
    if (i < known_) most = larger(most, change(now_[i], at_near_[i]));
  }
  return most;
}

double NearPairs::moved_since(const std::vector<SideNow>& then) const {
  double most = 0.0;
  for (std::size_t i = 0; i < known_; ++i) most = larger(most, change(now_[i], then[i]));
  return most;
}

template <class Real>
void NearPairs::follow(const Surface& surface, const Real* displacement) {
  const std::vector<ExposedSide>& sides = surface.sides();
  before_.swap(now_);
  now_.resize(sides.size());
  const std::size_t placed = before_.size();
  const double moved = move(sides, displacement);
  before_.insert(before_.end(), now_.begin() + static_cast<std::ptrdiff_t>(placed), now_.end());
  if (known_ == 0) {
    search({sides, now_, far_margin_});
  } else if (!within(moved, near_margin_)) {
    if (known_ < sides.size() || !within(moved_since(at_far_), far_margin_ - near_margin_))
      search({sides, now_, far_margin_});
    else
      select({sides, now_, near_margin_});
  } else if (known_ < sides.size()) {
    admit({sides, now_, far_margin_});
  }
}

void NearPairs::search(const SearchScene& scene) {
  ++searches_;
  known_ = scene.sides.size();
  cells_.find(scene, far_);
  at_far_ = now_;
  select({scene.sides, scene.now, near_margin_});
}

void NearPairs::select(const SearchScene& scene) {
  ++selections_;
  near_.clear();
  for (const SidePair& pair : far_) {
    const std::size_t u = static_cast<std::size_t>(pair.target), v = static_cast<std::size_t>(pair.side);
    if (may_touch(now_[u], now_[v], scene.sides[v].depth_limit, scene.margin)) near_.push_back(pair);
  }
  at_near_ = now_;
}

// Newly exposed sides join lists whose other sides have moved since: those pairs have more margin than they need.
void NearPairs::admit(const SearchScene& scene) {
  CellSearch::add(scene, known_, far_);
  CellSearch::add({scene.sides, scene.now, near_margin_}, known_, near_);
  at_far_.insert(at_far_.end(), now_.begin() + static_cast<std::ptrdiff_t>(known_), now_.end());
  at_near_.insert(at_near_.end(), now_.begin() + static_cast<std::ptrdiff_t>(known_), now_.end());
  known_ = scene.sides.size();
}

template void NearPairs::follow<float>(const Surface&, const float*);
template void NearPairs::follow<double>(const Surface&, const double*);

}  // namespace fracfarm::fdem
