// Which pairs of exposed sides may come into contact: cells of linear cost, after MRCK (Lei, Rougier, Knight, Munjiza 2014), as a list
// with a margin that stays good while nothing has moved further than a quarter of it. Decides nothing about forces.
#pragma once

#include <compare>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/fdem/contact/overlap.hpp"
#include "solver/fdem/contact/surface.hpp"

namespace fracfarm::fdem {

// Points of `target` against `side`, as places in a list of exposed sides.
struct SidePair {
  int target = 0, side = 0;
  auto operator<=>(const SidePair&) const = default;
};

struct SearchScene {
  std::span<const ExposedSide> sides;
  std::span<const SideNow> now;
  double margin;  // m
};

// All pairs of different triangles that may_touch, sorted, into `pairs`. A side with an end that is no number, 1e9 lengths away, or
// stretched to more than three times its length is left out: its triangle is destroyed, and the energy alarm's business.
class CellSearch {
 public:
  void find(const SearchScene& scene, std::vector<SidePair>& pairs);
  // Adds the pairs of the sides from `first` on to a list that holds those of the others: cost goes with all sides times the new ones.
  static void add(const SearchScene& scene, std::size_t first, std::vector<SidePair>& pairs);

 private:
  struct Entry {
    long long i, j;
    int side;
  };
  void fill_cells(const SearchScene& scene, double cell);
  std::size_t bucket(long long i, long long j) const;

  std::vector<std::size_t> start_;  // of every bucket in entries_
  std::vector<Entry> entries_, unsorted_;
};

// Not left out, see above.
bool sound(const ExposedSide& side, const SideNow& now);

}  // namespace fracfarm::fdem
