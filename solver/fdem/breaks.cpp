// What follows when joints break: their time and mode, and faces that contact must know.
#include "solver/fdem/solver.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

}  // namespace

template <class Real>
void Fdem<Real>::note_breaks(double time) {
  for (int b = 0; b < plan_.joint_blocks(); ++b) {
    if (!(state_.joint_state[static_cast<Index>(b)] & joint_broke)) continue;
    for (int l = 0; l < lanes; ++l) {
      const Index at = static_cast<Index>(b) * 2 * lanes + static_cast<Index>(l);
      const int edge = plan_.edge_of[static_cast<Index>(b * lanes + l)];
      if (edge < 0 || state_.damage[at] < Real(1) || state_.damage[at + lanes] < Real(1)) continue;
      double& broke = state_.break_time[static_cast<Index>(edge)];
      if (!std::isnan(broke)) continue;
      broke = time, state_.break_mode[static_cast<Index>(edge)] = static_cast<unsigned char>(mode_of(b, l));
      expose(plan_.left_side[static_cast<Index>(b * lanes + l)]), expose(plan_.right_side[static_cast<Index>(b * lanes + l)]);
    }
  }
}

template <class Real>
void Fdem<Real>::expose(int side) {
  contact_.expose(side);
  state_.exposed.push_back(side);
  watch_side(side);
}

// Forces of contact come in by the triangle's row of `extra`.
template <class Real>
void Fdem<Real>::watch_side(int side) {
  const int slot = side / 3;
  scratch_.needs[static_cast<Index>(slot / lanes)] |= needs_extra;
  scratch_.extra_slots.push_back(slot);
}

// The faces of initial cracks, once two of them overlap: before, contact has nothing to do.
template <class Real>
void Fdem<Real>::expose_cracks_that_close() {
  if (state_.cracks_exposed || (rules_.contact_after_break && !a_crack_closes())) return;
  state_.cracks_exposed = 1;
  for (const int side : plan_.crack_sides) expose(side);
}

template <class Real>
bool Fdem<Real>::a_crack_closes() const {
  for (Index i = 0; i + 1 < plan_.crack_sides.size(); i += 2) {
    const int row = row_of_side(plan_.crack_sides[i]);
    const Real *left = &scratch_.rows[static_cast<Index>(row)],
               *right = &scratch_.rows[static_cast<Index>(row_of_side(plan_.crack_sides[i + 1]))];
    const double* corners = &plan_.corner_rows[static_cast<Index>(row)];
    const Real x = static_cast<Real>(corners[2] - corners[0]), z = static_cast<Real>(corners[3] - corners[1]);
    if ((right[2] - left[0]) * z < (right[3] - left[1]) * x || (right[0] - left[2]) * z < (right[1] - left[3]) * x) return true;
  }
  return false;
}

// By the shares of opening and sliding, each of what breaks the joint alone, in their squares: three quarters of one name it.
template <class Real>
BreakMode Fdem<Real>::mode_of(int b, int l) const {
  const Index joint = static_cast<Index>(b * lanes + l), line = static_cast<Index>(b) * 2 * lanes + static_cast<Index>(l);
  const Real *left = &scratch_.rows[static_cast<Index>(plan_.left_row[joint])],
             *right = &scratch_.rows[static_cast<Index>(plan_.right_row[joint])];
  double x = plan_.along[line], z = plan_.along[line + lanes];
  x += 0.5 * ((double(left[2]) - left[0]) + (double(right[0]) - right[2]));
  z += 0.5 * ((double(left[3]) - left[1]) + (double(right[1]) - right[3]));
  const double ends[2][2] = {{double(right[2]) - left[0], double(right[3]) - left[1]},
                             {double(right[0]) - left[2], double(right[1]) - left[3]}};
  const auto& law = plan_.joint_laws[static_cast<Index>(plan_.joint_law_of_block[static_cast<Index>(b)])];
  double opens = 0.0, slides = 0.0;
  for (const auto& [dx, dz] : ends) {
    const double n = std::max(0.0, dx * z - dz * x) * law.per_rupture_n, t = (dx * x + dz * z) * law.per_rupture_t;
    opens += n * n, slides += t * t;
  }
  const double share = opens / std::max(opens + slides, 1e-300);
  return share >= 0.75 ? BreakMode::tension : share <= 0.25 ? BreakMode::shear : BreakMode::mixed;
}

#define FRACFARM_INSTANTIATE(Real)               \
  template void Fdem<Real>::note_breaks(double); \
  template void Fdem<Real>::expose(int);         \
  template void Fdem<Real>::watch_side(int);     \
  template void Fdem<Real>::expose_cracks_that_close();
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
