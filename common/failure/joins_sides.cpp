// Through crack by flood fill from the first side. Touches only the nodes that are joined to that side, so that it may be asked every step.
#include <algorithm>
#include <cassert>

#include "common/failure/failure.hpp"

namespace fracfarm {
namespace {

class Flood {
 public:
  Flood(const FieldView& field, double threshold, std::vector<unsigned char>& visited)
      : field_(field), threshold_(threshold), visited_(visited) {
    visited_.assign(field.values.size(), 0);
  }

  void enter(int column, int row) {
    const std::size_t node = static_cast<std::size_t>(row) * static_cast<std::size_t>(field_.columns) + static_cast<std::size_t>(column);
    if (visited_[node] || !(field_.values[node] > threshold_)) return;
    visited_[node] = 1;
    open_.push_back({column, row});
  }

  // True as soon as `arrived(column, row)` holds for a node that was reached.
  template <class Arrived>
  bool spread(Arrived arrived) {
    while (!open_.empty()) {
      const auto [column, row] = open_.back();
      open_.pop_back();
      if (arrived(column, row)) return true;
      for (int r = std::max(row - 1, 0); r <= std::min(row + 1, field_.rows - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, field_.columns - 1); ++c) enter(c, r);
    }
    return false;
  }

 private:
  const FieldView& field_;
  double threshold_;
  std::vector<unsigned char>& visited_;
  struct Node {
    int column, row;
  };
  std::vector<Node> open_;  // reached, neighbours not yet looked at
};

}  // namespace

bool joins_sides(const FieldView& field, double threshold, CrackDirection direction, std::vector<unsigned char>& visited) {
  assert(field.values.size() == static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows));
  if (field.values.empty()) return false;
  Flood flood(field, threshold, visited);
  if (direction == CrackDirection::left_right) {
    for (int row = 0; row < field.rows; ++row) flood.enter(0, row);
    return flood.spread([&](int column, int) { return column == field.columns - 1; });
  }
  for (int column = 0; column < field.columns; ++column) flood.enter(column, 0);
  return flood.spread([&](int, int row) { return row == field.rows - 1; });
}

}  // namespace fracfarm
