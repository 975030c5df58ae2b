#include "solver/crack_paths.hpp"

#include <algorithm>
#include <utility>

namespace fracfarm {
namespace {

constexpr unsigned char left = 1, right = 2, bottom = 4, top = 8;

}  // namespace

void CrackPaths::update(int columns, int rows, std::span<const unsigned char> cracked, std::span<const int> changed) {
  columns_ = columns, rows_ = rows;
  const bool heals = std::any_of(changed.begin(), changed.end(), [&](int node) { return !cracked[static_cast<std::size_t>(node)]; });
  if (heals || parent_.size() != cracked.size()) return begin_anew(cracked);
  for (const int node : changed) add(node);
}

void CrackPaths::begin_anew(std::span<const unsigned char> cracked) {
  parent_.assign(cracked.size(), -1);
  sides_.resize(cracked.size());
  joined_[0] = joined_[1] = false;
  for (std::size_t node = 0; node < cracked.size(); ++node)
    if (cracked[node]) add(static_cast<int>(node));
}

// Neighbours that are in no set yet find this one when they are added.
void CrackPaths::add(int node) {
  const int column = node % columns_, row = node / columns_;
  parent_[static_cast<std::size_t>(node)] = node;
  sides_[static_cast<std::size_t>(node)] = static_cast<unsigned char>((column == 0 ? left : 0) | (column == columns_ - 1 ? right : 0) |
                                                                      (row == 0 ? bottom : 0) | (row == rows_ - 1 ? top : 0));
  unite(node, node);
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r)
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c)
      if (const int other = r * columns_ + c; parent_[static_cast<std::size_t>(other)] >= 0) unite(node, other);
}

void CrackPaths::unite(int a, int b) {
  const int root = root_of(a), other = root_of(b);
  parent_[static_cast<std::size_t>(other)] = root;
  unsigned char& sides = sides_[static_cast<std::size_t>(root)];
  sides = static_cast<unsigned char>(sides | sides_[static_cast<std::size_t>(other)]);
  if ((sides & (left | right)) == (left | right)) joined_[static_cast<std::size_t>(CrackDirection::left_right)] = true;
  if ((sides & (bottom | top)) == (bottom | top)) joined_[static_cast<std::size_t>(CrackDirection::bottom_top)] = true;
}

// Halves the path on its way.
int CrackPaths::root_of(int node) {
  while (parent_[static_cast<std::size_t>(node)] != node) {
    int& parent = parent_[static_cast<std::size_t>(node)];
    parent = parent_[static_cast<std::size_t>(parent)];
    node = parent;
  }
  return node;
}

}  // namespace fracfarm
