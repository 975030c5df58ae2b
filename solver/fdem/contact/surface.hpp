// The exposed sides of the triangles and how they follow one another around a body: topology and undeformed lengths only, nothing of
// motion.
#pragma once

#include <span>
#include <vector>

#include "solver/fdem/contact/overlap.hpp"

namespace fracfarm::fdem {

using TriangleSide = int;  // edge k of triangle t, as 3 t + k, from corner k to corner k + 1, counter-clockwise

struct Exposure {
  TriangleSide side = 0;
  int was_joined = 0;  // 1: by a joint until now; 0: a crack from the start, or a boundary
  bool operator==(const Exposure&) const = default;
};

struct ExposedSide {
  TriangleSide id = 0;
  int triangle = 0;
  bool was_joined = false;
  int force_start = 0, force_end = 0;  // where the forces of its corners go in rows of 8 (columns 0 to 5)
  double length = 0.0;                 // undeformed, m
  double depth_limit = 0.0;            // m, deeper than this below the side is not in contact with it
  int next = -1, previous = -1;        // places in the list of the sides that bound the same body here, -1: not exposed
  bool joined_end = false;             // the corner with `next` is one corner of the body, no notch
  bool joined_start = false;
};

class Surface {
 public:
  // `corners`: rows of 8 as in Contact; `neighbour[3 t + k]`: the side across, or -1. Both stay with the caller.
  Surface(const std::vector<double>& corners, std::span<const TriangleSide> neighbour);

  // Known from the next commit() on. A side that is known already changes nothing.
  void expose(const Exposure& exposure);
  bool pending() const { return !pending_.empty(); }
  // Back to no side at all; do these sides exist?
  void clear();
  bool knows(std::span<const Exposure> exposures) const;
  // Takes the pending sides into the list, at its end, and links every side with its neighbours around the body.
  void commit();

  const std::vector<ExposedSide>& sides() const { return sides_; }
  const std::vector<SideNow>& undeformed() const { return undeformed_; }  // by place
  // By place: the first of a side's four numbers in rows of 8, x z of its start, x z of its end.
  const std::vector<int>& rows() const { return rows_; }
  const std::vector<Exposure>& order() const { return order_; }  // as exposed, committed ones first
  std::size_t committed() const { return sides_.size(); }
  int place(TriangleSide side) const { return place_[static_cast<std::size_t>(side)]; }  // in sides(), -1: not exposed
  int opposite(int place) const;                                                         // the place of the side across its edge, -1: none
  double mean_length() const {
    return mean_length_;
  }  // m, of an equilateral triangle of the mean area; rows that are pads, of no area, do not count

  // Sides that may not push each other: of one triangle, or meeting at one corner of one body whose void wedge is wider than 90 degrees, so
  // that it cannot close while unbroken joints hold the body together around that corner.
  bool same_corner(int u, int v) const;

 private:
  void link(int from, int to, double angle);
  void link_around(int place);

  std::span<const double> corners_;
  std::span<const TriangleSide> neighbour_;
  std::vector<Exposure> order_, pending_;
  std::vector<ExposedSide> sides_;
  std::vector<SideNow> undeformed_;
  std::vector<int> rows_;
  std::vector<int> place_;  // by side; -1 unknown, -2 pending
  double mean_length_ = 0.0;
};

}  // namespace fracfarm::fdem
