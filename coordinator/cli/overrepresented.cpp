#include "coordinator/cli/overrepresented.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace fracfarm::cli {
namespace {

double log_choose(std::uint64_t n, std::uint64_t k) {
  const auto a = static_cast<double>(n), b = static_cast<double>(k);
  return std::lgamma(a + 1.0) - std::lgamma(b + 1.0) - std::lgamma(a - b + 1.0);
}

using Counts = std::map<std::pair<std::string, std::string>, std::uint64_t>;

Counts count(const std::vector<Features>& jobs) {
  Counts counts;
  for (const Features& job : jobs)
    for (const auto& feature : job) ++counts[feature];
  return counts;
}

}  // namespace

double fisher_tail(std::uint64_t with, std::uint64_t drawn, std::uint64_t total_with, std::uint64_t total) {
  double p = 0.0;
  for (std::uint64_t k = with; k <= std::min(drawn, total_with); ++k)
    if (drawn - k <= total - total_with)
      p += std::exp(log_choose(total_with, k) + log_choose(total - total_with, drawn - k) - log_choose(total, drawn));
  return std::min(1.0, p);
}

Interval wilson(std::uint64_t hits, std::uint64_t n) {
  if (n == 0) return {};
  constexpr double z = 1.959963984540054;
  const auto m = static_cast<double>(n);
  const double share = static_cast<double>(hits) / m, z2 = z * z / m;
  const double centre = (share + z2 / 2.0) / (1.0 + z2), half = z / (1.0 + z2) * std::sqrt(share * (1.0 - share) / m + z2 / (4.0 * m));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

std::vector<Standing> standing_out(const std::vector<Features>& failed, const std::vector<Features>& sound, double sound_weight) {
  Counts among_failed = count(failed);
  const Counts among_sound = count(sound);
  std::vector<Standing> list;
  const auto tests = static_cast<double>(among_failed.size());
  for (const auto& [feature, n] : among_failed) {
    const auto other = among_sound.find(feature);
    Standing it{
        feature.first, feature.second, n, failed.size(), other == among_sound.end() ? 0 : other->second, sound.size(), 0.0, 0.0, 0.0, 1.0};
    const double all_with = static_cast<double>(it.failed_with) + sound_weight * static_cast<double>(it.sound_with);
    const double all = static_cast<double>(it.failed) + sound_weight * static_cast<double>(it.sound);
    it.lift = static_cast<double>(it.failed_with) / static_cast<double>(it.failed) * all / all_with;
    std::tie(it.low, it.high) = std::pair(wilson(it.failed_with, it.failed).low, wilson(it.failed_with, it.failed).high);
    it.p = std::min(1.0, tests * fisher_tail(it.failed_with, it.failed, it.failed_with + it.sound_with, it.failed + it.sound));
    list.push_back(std::move(it));
  }
  std::sort(list.begin(), list.end(), [](const Standing& a, const Standing& b) {
    return std::tuple(a.p, -a.lift, a.feature, a.value) < std::tuple(b.p, -b.lift, b.feature, b.value);
  });
  return list;
}

}  // namespace fracfarm::cli
