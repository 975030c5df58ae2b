#include "solver/fdem/contact/search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace fracfarm::fdem {
namespace {

constexpr double most_stretched = 3.0;  // of a side's undeformed length
constexpr double furthest = 1e9;        // lengths from the origin

double square_of(const SideNow& now) {
  const double x = now.bx - now.ax, z = now.bz - now.az;
  return x * x + z * z;
}

long long cell_of(double x, double cell) { return static_cast<long long>(std::floor(x / cell)); }

// Can the two be within `reach` of each other? Cheaper than may_touch, and true wherever that is.
bool boxes_meet(const SideNow& a, const SideNow& b, double reach) {
  return std::min(a.ax, a.bx) < std::max(b.ax, b.bx) + reach && std::min(b.ax, b.bx) < std::max(a.ax, a.bx) + reach &&
         std::min(a.az, a.bz) < std::max(b.az, b.bz) + reach && std::min(b.az, b.bz) < std::max(a.az, a.bz) + reach;
}

bool wanted(const SearchScene& scene, int target, int side) {
  const std::size_t u = static_cast<std::size_t>(target), v = static_cast<std::size_t>(side);
  return scene.sides[u].triangle != scene.sides[v].triangle &&
         may_touch(scene.now[u], scene.now[v], scene.sides[v].depth_limit, scene.margin);
}

}  // namespace

bool sound(const ExposedSide& side, const SideNow& now) {
  const double most = most_stretched * side.length, far = furthest * side.length, square = square_of(now);
  return square > 0.0 && square <= most * most && std::abs(now.ax) < far && std::abs(now.az) < far;
}

double reach_of(const SearchScene& scene) {
  double deepest = 0.0;
  for (const ExposedSide& side : scene.sides) deepest = std::max(deepest, side.depth_limit);
  return 2.0 * deepest + 3.0 * scene.margin;
}

std::size_t CellSearch::bucket(long long i, long long j) const {
  const std::uint64_t mixed = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Fu;
  return static_cast<std::size_t>(mixed >> 32) & (start_.size() - 2);
}

// Every target once, in the cell of its middle, sorted into buckets by counting.
void CellSearch::fill_cells(const SearchScene& scene, double cell) {
  unsorted_.clear();
  for (std::size_t u = 0; u < scene.sides.size(); ++u) {
    const SideNow& now = scene.now[u];
    if (!sound(scene.sides[u], now)) continue;
    const PlanePoint middle = point_on(now, 0.5);
    unsorted_.push_back({cell_of(middle.x, cell), cell_of(middle.z, cell), static_cast<int>(u)});
  }
  start_.assign(std::bit_ceil(2 * unsorted_.size() + 2) + 1, 0);
  for (const Entry& entry : unsorted_) ++start_[bucket(entry.i, entry.j)];
  for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
  entries_.resize(unsorted_.size());
  for (std::size_t n = unsorted_.size(); n-- > 0;) entries_[--start_[bucket(unsorted_[n].i, unsorted_[n].j)]] = unsorted_[n];
}

void CellSearch::find(const SearchScene& scene, std::vector<SidePair>& pairs) {
  pairs.clear();
  double longest = 0.0;
  for (std::size_t v = 0; v < scene.sides.size(); ++v)
    if (sound(scene.sides[v], scene.now[v])) longest = std::max(longest, std::sqrt(square_of(scene.now[v])));
  if (longest == 0.0) return;
  const double reach = reach_of(scene) + 0.5 * longest, cell = longest + reach;
  fill_cells(scene, cell);
  for (std::size_t v = 0; v < scene.sides.size(); ++v) {
    const SideNow& now = scene.now[v];
    if (!sound(scene.sides[v], now)) continue;
    const auto [left, right] = std::minmax(now.ax, now.bx);
    const auto [low, high] = std::minmax(now.az, now.bz);
    for (long long i = cell_of(left - reach, cell); i <= cell_of(right + reach, cell); ++i)
      for (long long j = cell_of(low - reach, cell); j <= cell_of(high + reach, cell); ++j) {
        const std::size_t b = bucket(i, j);
        for (std::size_t n = start_[b]; n < start_[b + 1]; ++n)
          if (entries_[n].i == i && entries_[n].j == j && wanted(scene, entries_[n].side, static_cast<int>(v)))
            pairs.push_back({entries_[n].side, static_cast<int>(v)});
      }
  }
  std::sort(pairs.begin(), pairs.end());
}

void CellSearch::add(const SearchScene& scene, std::size_t first, std::vector<SidePair>& pairs) {
  const std::ptrdiff_t known = static_cast<std::ptrdiff_t>(pairs.size());
  const double reach = reach_of(scene);
  for (std::size_t n = first; n < scene.sides.size(); ++n) {
    if (!sound(scene.sides[n], scene.now[n])) continue;
    for (std::size_t other = 0; other < scene.sides.size(); ++other) {
      if (!boxes_meet(scene.now[n], scene.now[other], reach) || !sound(scene.sides[other], scene.now[other])) continue;
      const int u = static_cast<int>(n), v = static_cast<int>(other);
      if (wanted(scene, u, v)) pairs.push_back({u, v});
      if (other < first && wanted(scene, v, u)) pairs.push_back({v, u});
    }
  }
  std::sort(pairs.begin() + known, pairs.end());
  std::inplace_merge(pairs.begin(), pairs.begin() + known, pairs.end());
}

}  // namespace fracfarm::fdem
