#include "common/failure/peaks.hpp"

#include <algorithm>

namespace fracfarm {
namespace {

// For each sample the lowest value on the way back to the nearest earlier sample that is strictly higher (or to the start).
template <class Iterator>
std::vector<double> lowest_before_higher(Iterator first, Iterator last) {
  struct Hill {
    double height, lowest;
  };
  std::vector<Hill> higher;  // falling heights; `lowest` is the lowest value after the hill before it
  std::vector<double> result;
  for (; first != last; ++first) {
    double lowest = *first;
    while (!higher.empty() && !(higher.back().height > *first)) {
      lowest = std::min(lowest, higher.back().lowest);
      higher.pop_back();
    }
    higher.push_back({*first, lowest});
    result.push_back(lowest);
  }
  return result;
}

}  // namespace

std::vector<Peak> local_maxima(std::span<const double> values) {
  std::vector<Peak> peaks;
  const std::vector<double> left = lowest_before_higher(values.begin(), values.end());
  std::vector<double> right = lowest_before_higher(values.rbegin(), values.rend());
  std::reverse(right.begin(), right.end());
  std::vector<double> highest(values.begin(), values.end());  // from each sample on
  for (std::size_t i = highest.size(); i-- > 1;) highest[i - 1] = std::max(highest[i - 1], highest[i]);
  for (std::size_t i = 1; i + 1 < values.size();) {
    std::size_t end = i;  // last sample of the flat top that begins at i
    while (end + 1 < values.size() && values[end + 1] == values[i]) ++end;
    if (values[i - 1] < values[i] && end + 1 < values.size() && values[end + 1] < values[i]) {
      const std::size_t middle = (i + end) / 2;
      const double prominence = values[middle] - std::max(left[middle], right[middle]);
      peaks.push_back({middle, prominence, highest[middle] > values[middle] ? prominence : values[middle] - left[middle]});
    }
    i = end + 1;
  }
  return peaks;
}

double prominence_needed(std::span<const double> values, double fraction) {
  if (values.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fraction * (*high - *low);
}

std::vector<std::size_t> prominent_peaks(std::span<const double> values, double fraction) {
  std::vector<std::size_t> result;
  const double needed = prominence_needed(values, fraction);
  for (const Peak& peak : local_maxima(values))
    if (peak.prominence >= needed) result.push_back(peak.index);
  return result;
}

}  // namespace fracfarm
