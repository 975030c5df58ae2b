#include "solver/fdem/mesh/repair.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "common/base/text.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/geometry.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double most_elements = 2e6;  // squares of the element size in the body
constexpr double most_metres = 1e6;
constexpr int most_rounds = 5;  // of repair; what is left then is the crack graph's

std::string mm(double metres) { return fmt::format("{:.4g} mm", 1e3 * metres); }

std::string refused_layer(const MeshChoice& choice, double tolerance) {
  for (std::size_t i = 0; i < choice.layers.size(); ++i) {
    const double z = choice.layers[i];
    double gap = std::min(z, choice.height - z);
    for (std::size_t j = 0; j < i; ++j) gap = std::min(gap, std::fabs(z - choice.layers[j]));
    if (!(gap >= tolerance))
      return fmt::format("the layer boundary at {} m lies {} from a side or from another one; at least half an element, {}", shortest(z),
                         mm(gap), mm(tolerance));
  }
  return {};
}

std::string short_crack(const MeshChoice& choice, double tolerance) {
  for (std::size_t i = 0; i < choice.cracks.size(); ++i)
    if (const double its = length(choice.cracks[i]); its < tolerance)
      return fmt::format("crack {} is {} long; at least half an element, {}", i, mm(its), mm(tolerance));
  return {};
}

std::string too_many_cracks(const MeshChoice& choice) {
  double total = 0.0;
  for (Segment crack : choice.cracks)
    if (clip(crack, choice.width, choice.height)) total += length(crack) + choice.element_size;
  const double most = 2 * choice.width * choice.height / choice.element_size + 4 * choice.element_size;
  if (total <= most) return {};
  return fmt::format("the cracks have {:.4g} m together; at most {:.4g} m with elements of {}", total, most, mm(choice.element_size));
}

// One round's work on the cracks; every step says whether it changed anything.
class Repairer {
 public:
  Repairer(const MeshChoice& choice, double tolerance) : choice_(choice), tolerance_(tolerance), already_(1e-6 * tolerance) {
    for (Segment crack : choice.cracks)
      if (clip(crack, choice.width, choice.height)) {
        out_.cracks.push_back(crack);
        drawn_.push_back({crack});
      }
    const double w = choice.width, h = choice.height;
    fixed_ = {{0, 0, w, 0}, {0, h, w, h}, {0, 0, 0, h}, {w, 0, w, h}};
    for (const double z : choice.layers) fixed_.push_back({0, z, w, z});
  }

  RepairedCracks run() {
    bool changed = true;
    for (int round = 0; round < most_rounds && changed; ++round) {
      changed = leave_sides();
      changed = join_parallel() || changed;
      changed = mend_ends() || changed;
      drop_short();
    }
    return std::move(out_);
  }

 private:
  std::vector<Segment>& cracks() { return out_.cracks; }

  void erase(std::size_t i) {
    out_.cracks.erase(out_.cracks.begin() + static_cast<std::ptrdiff_t>(i));
    drawn_.erase(drawn_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  // Repairs follow each other: the line of a crack stays within the tolerance of the ends of every crack that it stands for.
  bool stays_near(const Segment& line, const std::vector<Segment>& drawn) const {
    const Vec a = fdem::first(line), b = last(line);
    const auto near = [&](Vec p) { return distance(p, along(a, b, foot_share(p, a, b))) < 1.000001 * tolerance_; };
    return std::all_of(drawn.begin(), drawn.end(), [&](const Segment& one) { return near(fdem::first(one)) && near(last(one)); });
  }

  // A crack along a side separates nothing: it goes. One along a layer is moved onto it.
  bool leave_sides() {
    bool changed = false;
    for (std::size_t i = 0; i < cracks().size();) {
      const int line = fixed_along(cracks()[i]);
      if (line >= 0 && line < 4) {
        erase(i);
        ++out_.moved;
        changed = true;
        continue;
      }
      if (line >= 4) changed = put_at_height(i, fixed_[static_cast<std::size_t>(line)].z0) || changed;
      ++i;
    }
    return changed;
  }

  int fixed_along(const Segment& crack) const {
    for (std::size_t k = 0; k < fixed_.size(); ++k)
      if (distance_to(fdem::first(crack), fdem::first(fixed_[k]), last(fixed_[k])) < tolerance_ &&
          distance_to(last(crack), fdem::first(fixed_[k]), last(fixed_[k])) < tolerance_)
        return static_cast<int>(k);
    return -1;
  }

  bool put_at_height(std::size_t i, double z) {
    const Segment level{cracks()[i].x0, z, cracks()[i].x1, z};
    if (cracks()[i] == level || !stays_near(level, drawn_[i])) return false;
    cracks()[i] = level;
    ++out_.moved;
    return true;
  }

  bool join_parallel() {
    bool changed = false;
    for (std::size_t i = 0; i < cracks().size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (join(i, j)) {
          changed = true;
          --i;  // what was i is gone
          break;
        }
    return changed;
  }

  // Crack i becomes a part of the older crack j, on the line of whichever of the two the other lies along.
  bool join(std::size_t i, std::size_t j) {
    const bool onto_older = lies_along(cracks()[i], cracks()[j]);
    if (!onto_older && !lies_along(cracks()[j], cracks()[i])) return false;
    const Segment both = onto_older ? united(cracks()[j], cracks()[i]) : united(cracks()[i], cracks()[j]);
    if (!stays_near(both, drawn_[i]) || !stays_near(both, drawn_[j])) return false;
    cracks()[j] = both;
    drawn_[j].insert(drawn_[j].end(), drawn_[i].begin(), drawn_[i].end());
    erase(i);
    ++out_.moved;
    return true;
  }

  // Both ends of `it` within tolerance of the line of `of`, and their lengths overlap or touch.
  bool lies_along(const Segment& it, const Segment& of) const {
    const Vec a = fdem::first(of), b = last(of), p = fdem::first(it), q = last(it);
    const double sp = foot_share(p, a, b), sq = foot_share(q, a, b);
    if (distance(p, along(a, b, sp)) >= tolerance_ || distance(q, along(a, b, sq)) >= tolerance_) return false;
    return std::max(sp, sq) > 0 && std::min(sp, sq) < 1;
  }

  // Along the line of `line`, from the first to the last end of the two.
  static Segment united(const Segment& line, const Segment& other) {
    const Vec a = fdem::first(line), b = last(line);
    const double s = foot_share(fdem::first(other), a, b), t = foot_share(last(other), a, b);
    const double low = std::min({0.0, s, t}), high = std::max({1.0, s, t});
    const Vec p = low < 0 ? along(a, b, low) : a, q = high > 1 ? along(a, b, high) : b;
    return {p.x, p.z, q.x, q.z};
  }

  bool mend_ends() {
    bool changed = false;
    for (std::size_t i = 0; i < cracks().size(); ++i)
      for (const bool at_last : {false, true}) {
        for (std::size_t k = 0; k < fixed_.size(); ++k) changed = mend_end(i, at_last, fixed_[k], false) || changed;
        for (std::size_t j = 0; j < cracks().size(); ++j)
          if (j != i) changed = mend_end(i, at_last, cracks()[j], true) || changed;
      }
    return changed;
  }

  // The end of crack i goes to where its line meets `other`; where that is far or nowhere, to the nearest point of `other`.
  bool mend_end(std::size_t i, bool at_last, const Segment& other, bool is_crack) {
    Segment& crack = cracks()[i];
    const Vec from = at_last ? fdem::first(crack) : last(crack), end = at_last ? last(crack) : fdem::first(crack);
    const Vec c = fdem::first(other), d = last(other);
    if (end.x < std::min(c.x, d.x) - tolerance_ || end.x > std::max(c.x, d.x) + tolerance_ || end.z < std::min(c.z, d.z) - tolerance_ ||
        end.z > std::max(c.z, d.z) + tolerance_)
      return false;
    const double gap = distance_to(end, c, d);
    if (gap >= tolerance_ || gap <= already_ || distance(from, end) <= already_) return false;
    Vec target = nearest_on(end, c, d);
    if (const auto meet = meeting(from, end, c, d)) {
      const Vec there = along(from, end, meet->first);
      const double beyond = std::max({0.0, -meet->second, meet->second - 1}) * distance(c, d);
      if (meet->first > 0 && distance(there, end) < 2 * tolerance_ && (beyond == 0 || (is_crack && beyond < tolerance_))) target = there;
    }
    target = {std::clamp(target.x, 0.0, choice_.width), std::clamp(target.z, 0.0, choice_.height)};
    for (const auto& [p, q] : {std::pair{from, end}, std::pair{c, d}}) {  // upright and level lines stay so to the bit
      if (p.x == q.x && std::fabs(target.x - p.x) <= already_) target.x = p.x;
      if (p.z == q.z && std::fabs(target.z - p.z) <= already_) target.z = p.z;
    }
    const Segment mended = at_last ? Segment{from.x, from.z, target.x, target.z} : Segment{target.x, target.z, from.x, from.z};
    if (distance(target, end) <= already_ || !stays_near(mended, drawn_[i])) return false;
    ++(distance(from, target) < distance(from, end) ? out_.trimmed : out_.extended);
    crack = mended;
    return true;
  }

  // What was trimmed away altogether.
  void drop_short() {
    for (std::size_t i = cracks().size(); i-- > 0;)
      if (length(cracks()[i]) < tolerance_) erase(i);
  }

  const MeshChoice& choice_;
  double tolerance_, already_;
  std::vector<Segment> fixed_;               // four sides, then layers
  std::vector<std::vector<Segment>> drawn_;  // what each crack stands for
  RepairedCracks out_;
};

}  // namespace

std::string refusal_of_numbers(const MeshChoice& choice) {
  for (const double size : {choice.element_size, choice.width, choice.height})
    if (!(size > 0 && size < most_metres)) return fmt::format("width, height and element size must be above 0 and below {} m", most_metres);
  for (std::size_t i = 0; i < choice.cracks.size(); ++i)
    for (const double value : {choice.cracks[i].x0, choice.cracks[i].z0, choice.cracks[i].x1, choice.cracks[i].z1})
      if (!(std::fabs(value) < most_metres)) return fmt::format("crack {} has an end that is not finite or beyond {} m", i, most_metres);
  return too_many_cracks(choice);
}

std::string refusal(const MeshChoice& choice) {
  if (std::string sentence = refusal_of_numbers(choice); !sentence.empty()) return sentence;
  const double h = choice.element_size, tolerance = 0.5 * h;
  if (std::min(choice.width, choice.height) < 2 * h)
    return fmt::format("the body is {} x {}; at least two elements of {} each way", mm(choice.width), mm(choice.height), mm(h));
  if (choice.width * choice.height > most_elements * h * h)
    return fmt::format("{:.3g} squares of {} would fit in the body; at most {:.3g}", choice.width * choice.height / (h * h), mm(h),
                       most_elements);
  if (std::string sentence = refused_layer(choice, tolerance); !sentence.empty()) return sentence;
  return short_crack(choice, tolerance);
}

RepairedCracks repair(const MeshChoice& choice) { return Repairer(choice, 0.5 * choice.element_size).run(); }

}  // namespace fracfarm::fdem
