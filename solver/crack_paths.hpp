// Paths of cracked nodes between the sides of a grid, over 8 neighbours as joins_sides() finds them, kept while nodes crack one after
// another: sets of joined nodes, each with the sides that it touches. A node that heals makes them anew.
#pragma once

#include <span>
#include <vector>

#include "common/failure/failure.hpp"

namespace fracfarm {

class CrackPaths {
 public:
  // After the marks (1 where cracked) of the nodes `changed` changed; row 0 is at the bottom.
  void update(int columns, int rows, std::span<const unsigned char> cracked, std::span<const int> changed);
  bool join(CrackDirection direction) const { return joined_[static_cast<std::size_t>(direction)]; }

 private:
  void begin_anew(std::span<const unsigned char> cracked);
  void add(int node);
  void unite(int a, int b);
  int root_of(int node);

  int columns_ = 0, rows_ = 0;
  std::vector<int> parent_;           // by node; itself where it is a root, -1 where it is in no set
  std::vector<unsigned char> sides_;  // by root: a bit for each side that its set touches
  bool joined_[2] = {false, false};   // by direction
};

}  // namespace fracfarm
