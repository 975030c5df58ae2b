#include "solver/phasefield/slots.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::phasefield {
namespace {

constexpr double touch = 1e-9;  // in cells: nearer than this to a grid line counts as on it

double snapped(double cells) {
  const double line = std::round(cells);
  return std::abs(cells - line) < touch ? line : cells;
}

// Parameters at which a coordinate running from a to b (in cells) crosses the grid's lines 0...count.
void add_crossings(double a, double b, int count, std::vector<double>& cuts) {
  if (a == b) return;
  const double first = std::max(std::ceil(std::min(a, b)), 0.0);
  const double last = std::min(std::max(a, b), static_cast<double>(count));
  for (double line = first; line <= last; line += 1.0) cuts.push_back((line - a) / (b - a));
}

// The cell of a coordinate; the last grid line belongs to the last cell; -1 outside.
int cell_of(double cells, int count) {
  if (cells < 0.0 || cells > count) return -1;
  return std::min(static_cast<int>(std::floor(cells)), count - 1);
}

}  // namespace

std::vector<std::pair<int, int>> crossed_elements(const Segment& segment, const Grid& grid) {
  const double x0 = snapped(segment.x0 / grid.hx), x1 = snapped(segment.x1 / grid.hx);
  const double z0 = snapped(segment.z0 / grid.hz), z1 = snapped(segment.z1 / grid.hz);
  std::vector<double> cuts{0.0, 1.0};
  add_crossings(x0, x1, grid.cells_x(), cuts);
  add_crossings(z0, z1, grid.cells_z(), cuts);
  std::sort(cuts.begin(), cuts.end());
  const double length = std::hypot(x1 - x0, z1 - z0);
  std::vector<std::pair<int, int>> elements;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if ((cuts[k + 1] - cuts[k]) * length < touch) continue;
    const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
    const int i = cell_of(x0 + middle * (x1 - x0), grid.cells_x());
    const int j = cell_of(z0 + middle * (z1 - z0), grid.cells_z());
    if (i >= 0 && j >= 0) elements.emplace_back(i, j);
  }
  return elements;
}

std::vector<unsigned char> slot_mask(std::span<const Segment> cracks, const Grid& grid) {
  std::vector<unsigned char> mask(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), 0);
  for (const Segment& crack : cracks)
    for (const auto& [i, j] : crossed_elements(crack, grid))
      for (const int row : {j, j + 1})
        for (const int column : {i, i + 1}) mask[static_cast<std::size_t>(row * grid.columns + column)] = 1;
  return mask;
}

}  // namespace fracfarm::phasefield
