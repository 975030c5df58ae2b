#include "solver/fdem/contact/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fracfarm::fdem {
namespace {

double larger(double a, double b) { return a > b ? a : b; }

// Largest change of a coordinate; what is no number does not count, nor does it touch anything.
double change(const SideNow& a, const SideNow& b) {
  return larger(larger(std::abs(a.ax - b.ax), std::abs(a.az - b.az)), larger(std::abs(a.bx - b.bx), std::abs(a.bz - b.bz)));
}

// A corner whose coordinates changed by `most` at most has moved this far at most; within `margin`?
bool within(double most, double margin) { return 4.0 * std::numbers::sqrt2 * most <= margin; }

template <class Real>
SideNow placed(const SideNow& undeformed, const Real* u) {
  return {undeformed.ax + static_cast<double>(u[0]), undeformed.az + static_cast<double>(u[1]), undeformed.bx + static_cast<double>(u[2]),
          undeformed.bz + static_cast<double>(u[3])};
}

}  // namespace

// Where the sides are now, and the largest change of a coordinate of the known ones since the near list was made.
template <class Real>
double NearPairs::move(const Surface& surface, const Real* displacement) {
  const SideNow* undeformed = surface.undeformed().data();
  const int* rows = surface.rows().data();
  double most = 0.0;
  for (std::size_t i = 0; i < known_; ++i) {
    now_[i] = placed(undeformed[i], displacement + rows[i]);
    most = larger(change(now_[i], at_near_[i]), most);
  }
  for (std::size_t i = known_; i < now_.size(); ++i) now_[i] = placed(undeformed[i], displacement + rows[i]);
  return most;
}

double NearPairs::moved_since(const std::vector<SideNow>& then) const {
  double most = 0.0;
  for (std::size_t i = 0; i < known_; ++i) most = larger(change(now_[i], then[i]), most);
  return most;
}

template <class Real>
void NearPairs::follow(const Surface& surface, const Real* displacement) {
  const std::size_t all = surface.sides().size();
  before_.swap(now_);
  now_.resize(all);
  const std::size_t placed = before_.size();
  const double moved = move(surface, displacement);
  before_.insert(before_.end(), now_.begin() + static_cast<std::ptrdiff_t>(placed), now_.end());
  if (known_ == 0) {
    search(surface);
  } else if (!within(moved, near_margin_)) {
    if (known_ < all || !within(moved_since(at_far_), far_margin_ - near_margin_))
      search(surface);
    else
      select(surface);
  } else if (known_ < all) {
    admit(surface);
  }
}

void NearPairs::search(const Surface& surface) {
  ++searches_;
  known_ = surface.sides().size();
  cells_.find({surface.sides(), now_, far_margin_}, far_);
  at_far_ = now_;
  select(surface);
}

void NearPairs::select(const Surface& surface) {
  ++selections_;
  near_.clear();
  for (const SidePair& pair : far_) {
    const std::size_t u = static_cast<std::size_t>(pair.target), v = static_cast<std::size_t>(pair.side);
    if (may_touch(now_[u], now_[v], surface.sides()[v].depth_limit, near_margin_)) near_.push_back(pair);
  }
  at_near_ = now_;
  cornered_.clear();
  part(surface);
}

// Newly exposed sides join lists whose other sides have moved since: those pairs have more margin than they need.
void NearPairs::admit(const Surface& surface) {
  CellSearch::add({surface.sides(), now_, far_margin_}, known_, far_);
  CellSearch::add({surface.sides(), now_, near_margin_}, known_, near_);
  at_far_.insert(at_far_.end(), now_.begin() + static_cast<std::ptrdiff_t>(known_), now_.end());
  at_near_.insert(at_near_.end(), now_.begin() + static_cast<std::ptrdiff_t>(known_), now_.end());
  known_ = surface.sides().size();
  near_.insert(near_.end(), cornered_.begin(), cornered_.end());
  cornered_.clear();
  std::sort(near_.begin(), near_.end());
  part(surface);
}

// Puts aside the near pairs whose sides meet at one corner of one body.
void NearPairs::part(const Surface& surface) {
  std::size_t kept = 0;
  for (const SidePair& pair : near_)
    if (surface.same_corner(pair.target, pair.side))
      cornered_.push_back(pair);
    else
      near_[kept++] = pair;
  near_.resize(kept);
}

template void NearPairs::follow<float>(const Surface&, const float*);
template void NearPairs::follow<double>(const Surface&, const double*);

}  // namespace fracfarm::fdem
