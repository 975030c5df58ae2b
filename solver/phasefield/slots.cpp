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

std::vector<unsigned char> node_mask(std::span<const Segment> cracks, const Grid& grid) {
  std::vector<unsigned char> mask(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), 0);
  const auto hold = [&](double column, double row) {
    const double i = std::round(column), j = std::round(row);
    if (i >= 0.0 && j >= 0.0 && i < grid.columns && j < grid.rows)
      mask[static_cast<std::size_t>(j) * grid.columns + static_cast<std::size_t>(i)] = 1;
  };
  for (const Segment& crack : cracks) {
    const double x0 = crack.x0 / grid.hx, x1 = crack.x1 / grid.hx, z0 = crack.z0 / grid.hz, z1 = crack.z1 / grid.hz;
    const bool across = std::abs(x1 - x0) >= std::abs(z1 - z0);
    const double from = across ? x0 : z0, to = across ? x1 : z1;
    if (from == to) hold(x0, z0);
    if (from == to) continue;
    const double first = std::max(std::round(std::min(from, to)), 0.0);
    const double last = std::min(std::round(std::max(from, to)), 1.0 * std::max(grid.columns, grid.rows));
    for (double line = first; line <= last; line += 1.0) {
      const double t = std::clamp((line - from) / (to - from), 0.0, 1.0);
      hold(across ? line : x0 + t * (x1 - x0), across ? z0 + t * (z1 - z0) : line);
    }
  }
  return mask;
}

std::vector<unsigned char> held_mask(CrackSeeding seeding, std::span<const Segment> cracks, const Grid& grid) {
  if (seeding == CrackSeeding::history) return slot_mask({}, grid);
  return seeding == CrackSeeding::nodes ? node_mask(cracks, grid) : slot_mask(cracks, grid);
}

std::vector<unsigned char> seeded_elements(CrackSeeding seeding, std::span<const Segment> cracks, const Grid& grid) {
  std::vector<unsigned char> seeded(static_cast<std::size_t>(grid.cells_x()) * static_cast<std::size_t>(grid.cells_z()), 0);
  if (seeding != CrackSeeding::history) return seeded;
  for (const Segment& crack : cracks)
    for (const auto& [i, j] : crossed_elements(crack, grid)) seeded[static_cast<std::size_t>(j * grid.cells_x() + i)] = 1;
  return seeded;
}

}  // namespace fracfarm::phasefield
