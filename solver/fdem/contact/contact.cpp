#include "solver/fdem/contact/contact.hpp"

#include <cassert>
#include <cmath>

namespace fracfarm::fdem {
namespace {

// Motion gives a distance but for rounding.
constexpr double slack = 1.001;

template <class Real>
void add_to_ends(const ExposedSide& side, const Ends& f, Real* force) {
  Real *start = force + side.force_start, *end = force + side.force_end;
  start[0] += static_cast<Real>(f.ax), start[1] += static_cast<Real>(f.az);
  end[0] += static_cast<Real>(f.bx), end[1] += static_cast<Real>(f.bz);
}

double point_of(const Touch& touch) { return point_place[static_cast<std::size_t>(touch.point)]; }

}  // namespace

template <class Real>
Contact<Real>::Contact(const CornerRows& corners, std::span<const TriangleSide> neighbour, ContactSettings settings)
    : friction_(settings.friction), surface_(corners, neighbour), near_(surface_.mean_length()) {
  stiffness_ = settings.triangle_penalty.empty() ? std::vector<double>{settings.penalty} : std::move(settings.triangle_penalty);
  assert(stiffness_.size() == 1 || stiffness_.size() == neighbour.size() / 3);
  for (double& stiffness : stiffness_) stiffness /= surface_.mean_length();
}

template <class Real>
void Contact<Real>::add_forces(const Real* displacement, Real* force) {
  if (!any()) return;
  fresh_ = surface_.committed();
  surface_.commit();
  near_.follow(surface_, displacement);
  last_.swap(touches_);
  find_touches();
  energies_.stored = 0.0;
  cursor_ = 0;
  for (std::size_t n = 0; n < touches_.size(); ++n) {
    Touch& touch = touches_[n];
    const RelativeMotion moved = motion_of(touch, places_[n]);
    remember(touch, places_[n].depth, slack * moved.length());
    energies_.friction += slide(touch, friction_, moved.along);
    energies_.stored += touch.stored();
    push(touch, places_[n], force);
  }
  let_go();
}

// Every point of the near pairs that is below the side of its pair, and in no other side's part of the boundary.
template <class Real>
void Contact<Real>::find_touches() {
  touches_.clear();
  places_.clear();
  const std::vector<SideNow>& now = near_.now();
  for (const SidePair& pair : near_.pairs()) {
    const std::size_t u = static_cast<std::size_t>(pair.target), v = static_cast<std::size_t>(pair.side);
    const ExposedSide &target = surface_.sides()[u], &side = surface_.sides()[v];
    if (!may_touch(now[u], now[v], side.depth_limit, 0.0) || !sound(target, now[u]) || !sound(side, now[v])) continue;
    const Axes a = axes(now[v]);
    for (std::size_t g = 0; g < point_place.size(); ++g) {
      const PlanePoint p = point_on(now[u], point_place[g]);
      const Place place = place_of(p, now[v], a);
      if (!(place.depth > 0.0 && place.depth < side.depth_limit) || !belongs_to(p, place, side, a)) continue;
      const double stiffness = stiffness_[stiffness_.size() == 1 ? 0 : static_cast<std::size_t>(side.triangle)];
      touches_.push_back({pair.target, pair.side, static_cast<int>(g), 0.0, 0.0, 0.0, stiffness * point_weight[g] * target.length, false});
      places_.push_back({place.depth, place.along / a.length, a});
    }
  }
}

// Two sides that meet at a corner part along its bisector, where the distances past the one's end and before the other's start are equal.
template <class Real>
bool Contact<Real>::belongs_to(const PlanePoint& p, const Place& place, const ExposedSide& side, const Axes& a) const {
  double before_end = a.length - place.along, after_start = place.along;
  if (before_end < -place.depth || after_start < -place.depth) return false;  // no mitre reaches further out than it is deep
  if (side.next >= 0 && side.joined_end) {
    const SideNow& next = near_.now()[static_cast<std::size_t>(side.next)];
    before_end -= place_of(p, next, axes(next)).along;
  }
  if (side.previous >= 0 && side.joined_start) {
    const SideNow& previous = near_.now()[static_cast<std::size_t>(side.previous)];
    const Axes b = axes(previous);
    after_start -= b.length - place_of(p, previous, b).along;
  }
  return before_end >= 0.0 && after_start > 0.0;
}

// The touch of the same point one step ago, with this side or with one that this side meets at a corner; null if there was none.
template <class Real>
Touch* Contact<Real>::last_touch(const Touch& touch) {
  while (cursor_ < last_.size() && last_[cursor_].target < touch.target) ++cursor_;
  const ExposedSide& side = surface_.sides()[static_cast<std::size_t>(touch.side)];
  Touch* found = nullptr;
  for (std::size_t n = cursor_; n < last_.size() && last_[n].target == touch.target; ++n) {
    Touch& last = last_[n];
    if (last.point != touch.point || last.carried_on) continue;
    if (last.side == touch.side) return &last;
    if ((side.joined_end && last.side == side.next) || (side.joined_start && last.side == side.previous)) found = &last;
  }
  return found;
}

template <class Real>
RelativeMotion Contact<Real>::motion_of(const Touch& touch, const TouchPlace& at) const {
  const std::size_t u = static_cast<std::size_t>(touch.target), v = static_cast<std::size_t>(touch.side);
  return relative_motion(at, point_of(touch), difference(near_.now()[u], near_.before()[u]), difference(near_.now()[v], near_.before()[v]));
}

// Between the faces of an edge whose joint broke in the last step?
template <class Real>
bool Contact<Real>::just_broke(const Touch& touch) const {
  const std::size_t later = static_cast<std::size_t>(std::max(touch.target, touch.side));
  return later >= fresh_ && surface_.sides()[later].was_joined && surface_.opposite(touch.target) == touch.side;
}

// Overlap and origin of the depth now: what motion over `reach` cannot have brought is no overlap.
template <class Real>
void Contact<Real>::remember(Touch& touch, double depth, double reach) {
  Touch* last = last_touch(touch);
  if (last) {
    last->carried_on = true;
    touch.slip = last->slip;
    touch.origin = last->side == touch.side ? std::min(last->origin, depth) : std::max(0.0, depth - last->overlap - reach);
  } else if (just_broke(touch)) {
    energies_.jumped += 0.5 * touch.stiffness * depth * depth;
  } else {
    touch.origin = std::max(0.0, depth - reach);
  }
  touch.overlap = depth - touch.origin;
}

template <class Real>
void Contact<Real>::push(const Touch& touch, const TouchPlace& at, Real* force) const {
  const EndForces f = end_forces(touch, at, point_of(touch));
  add_to_ends(surface_.sides()[static_cast<std::size_t>(touch.target)], f.target, force);
  add_to_ends(surface_.sides()[static_cast<std::size_t>(touch.side)], f.side, force);
}

// Touches that ended: their springs are heat, and an overlap larger than motion can have ended left without work.
template <class Real>
void Contact<Real>::let_go() {
  for (const Touch& touch : last_) {
    if (touch.carried_on) continue;
    energies_.friction += 0.5 * touch.stiffness * touch.slip * touch.slip;
    const std::size_t u = static_cast<std::size_t>(touch.target), v = static_cast<std::size_t>(touch.side);
    const Axes a = axes(near_.now()[v]);
    const Place place = place_of(point_on(near_.now()[u], point_of(touch)), near_.now()[v], a);
    const RelativeMotion moved = motion_of(touch, {place.depth, place.along / a.length, a});
    if (touch.overlap > slack * moved.length()) energies_.jumped -= 0.5 * touch.stiffness * touch.overlap * touch.overlap;
  }
}

template <class Real>
void Contact<Real>::save(ArchiveWriter& archive) const {
  archive.put_array(surface_.order());
  archive.put_array(near_.now());  // of the sides that have been in a step
  archive.put(static_cast<std::uint64_t>(touches_.size()));
  for (const Touch& t : touches_) {
    for (const int value : {t.target, t.side, t.point}) archive.put(value);
    for (const double value : {t.overlap, t.origin, t.slip, t.stiffness}) archive.put(value);
  }
  archive.put(energies_);
}

template <class Real>
void Contact<Real>::load(ArchiveReader& archive) {
  std::vector<Exposure> order;
  archive.get_array(order);
  std::vector<SideNow> now;
  archive.get_array(now);
  const std::size_t committed = now.size();
  const std::uint64_t touches = archive.get<std::uint64_t>();
  surface_.clear();
  near_.resume(std::move(now));
  touches_.clear();
  if (committed > order.size() || !surface_.knows(order)) return archive.reject();
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (n == committed) surface_.commit();
    surface_.expose(order[n]);
  }
  if (committed == order.size()) surface_.commit();
  for (std::uint64_t n = 0; n < touches && !archive.failed(); ++n) {
    Touch t;
    for (int* value : {&t.target, &t.side, &t.point}) *value = archive.get<int>();
    for (double* value : {&t.overlap, &t.origin, &t.slip, &t.stiffness}) *value = archive.get<double>();
    const auto known = [&](int place) { return place >= 0 && static_cast<std::size_t>(place) < surface_.committed(); };
    if (!known(t.target) || !known(t.side) || t.point < 0 || t.point > 2) return archive.reject();
    touches_.push_back(t);
  }
  energies_ = archive.get<ContactEnergies>();
}

template class Contact<float>;
template class Contact<double>;

}  // namespace fracfarm::fdem
