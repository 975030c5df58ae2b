// Dart throwing on a grid whose cells hold one point at most (R. L. Cook, Stochastic sampling in computer graphics, 1986).
#include "solver/fdem/mesh/free_points.hpp"

#include <numeric>

#include "common/base/random.hpp"

namespace fracfarm::fdem {
namespace {

enum Role : std::uint32_t { order_of_cells = 1001, place_in_cell };  // of the mesh seed's streams; the patterns' are below

constexpr int rounds = 3;  // one dart a cell each

class Darts {
 public:
  Darts(double width, double height, const Spacing& spacing)
      : width_(width),
        height_(height),
        least_(spacing.between * spacing.between),
        cell_(spacing.between / std::sqrt(2.0)),
        columns_(static_cast<int>(width / cell_) + 1),
        rows_(static_cast<int>(height / cell_) + 1),
        point_in_(static_cast<std::size_t>(columns_) * rows_, -1) {}

  std::vector<int> shuffled_cells(RandomStream& random) const {
    std::vector<int> cells(point_in_.size());
    std::iota(cells.begin(), cells.end(), 0);
    for (int i = static_cast<int>(cells.size()) - 1; i > 0; --i)
      std::swap(cells[static_cast<std::size_t>(i)], cells[static_cast<std::size_t>(random.integer(0, i))]);
    return cells;
  }

  void throw_at(int cell, RandomStream& random, const Spacing& spacing, const CrackGraph& lines) {
    if (point_in_[static_cast<std::size_t>(cell)] >= 0) return;
    const int column = cell % columns_, row = cell / columns_;
    const double x = random.uniform(), z = random.uniform();
    const Vec p{(column + x) * cell_, (row + z) * cell_};
    if (p.x >= width_ || p.z >= height_ || !apart(p, column, row) || !lines.clear(p, spacing.from_vertices, spacing.from_edges)) return;
    point_in_[static_cast<std::size_t>(cell)] = static_cast<int>(points_.size());
    points_.push_back(p);
  }

  std::vector<Vec>& points() { return points_; }

 private:
  bool apart(Vec p, int column, int row) const {
    for (int j = std::max(0, row - 2); j <= std::min(rows_ - 1, row + 2); ++j)
      for (int i = std::max(0, column - 2); i <= std::min(columns_ - 1, column + 2); ++i) {
        const int other = point_in_[static_cast<std::size_t>(j) * columns_ + i];
        if (other < 0) continue;
        const Vec gap = points_[static_cast<std::size_t>(other)] - p;
        if (dot(gap, gap) < least_) return false;
      }
    return true;
  }

  double width_, height_, least_, cell_;
  int columns_, rows_;
  std::vector<int> point_in_;
  std::vector<Vec> points_;
};

}  // namespace

// The share between free points makes the mean edge one element size, measured on random patterns; the others keep its mean along lines.
Spacing spacing_of(double element_size) { return {0.76 * element_size, 0.76 * element_size, 0.6 * element_size}; }

std::vector<Vec> throw_points(double width, double height, const Spacing& spacing, const CrackGraph& lines, std::uint64_t seed) {
  RandomStream order(seed, 0, order_of_cells), places(seed, 0, place_in_cell);
  Darts darts(width, height, spacing);
  const std::vector<int> cells = darts.shuffled_cells(order);
  for (int round = 0; round < rounds; ++round)
    for (const int cell : cells) darts.throw_at(cell, places, spacing, lines);
  return std::move(darts.points());
}

}  // namespace fracfarm::fdem
