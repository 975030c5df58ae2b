// Whether a body broke where it was whole at the start: without that, a lost mean stress is a body that rings or is let go, and no failure.
#pragma once

#include <algorithm>
#include <span>

#include "common/failure/failure.hpp"

namespace fracfarm {

// Damage on the same nodes, now and at t = 0 (initial cracks relaxed).
inline bool has_new_crack(std::span<const float> psi, std::span<const float> psi_initial) {
  for (std::size_t n = 0; n < std::min(psi.size(), psi_initial.size()); ++n)
    if (static_cast<double>(psi[n]) > through_crack_threshold && static_cast<double>(psi_initial[n]) <= through_crack_threshold)
      return true;
  return false;
}

}  // namespace fracfarm
