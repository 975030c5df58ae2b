// Random choices of the scene maker over one counter-based stream, so that scene K of a seed is the same whatever else is drawn.
#pragma once

#include <cmath>
#include <span>

#include "common/base/random.hpp"

namespace fracfarm::robustness {

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t index) : stream_(seed, index, 0x405713u) {}

  double uniform(double low, double high) { return stream_.uniform(low, high); }
  double log_uniform(double low, double high) { return low * std::pow(high / low, stream_.uniform()); }
  int integer(int low, int high) { return stream_.integer(low, high); }
  bool chance(double share) { return stream_.uniform() < share; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  std::size_t index(std::size_t size) { return static_cast<std::size_t>(stream_.integer(0, static_cast<int>(size) - 1)); }

  template <class T, std::size_t N>
  const T& pick(const T (&from)[N]) {
    return from[index(N)];
  }
  template <class T>
  const T& pick(std::span<const T> from) {
    return from[index(from.size())];
  }

 private:
  RandomStream stream_;
};

}  // namespace fracfarm::robustness
