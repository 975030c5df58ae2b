// What follows when joints break: their time and mode, and faces that contact must know.
#include <algorithm>
#include <cmath>

#include "solver/fdem/followed.hpp"
#include "solver/fdem/solver.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

double edge_length(const TriangleMesh& mesh, Index edge) {
  const auto &a = mesh.nodes[static_cast<Index>(mesh.edge_nodes[edge][0])], &b = mesh.nodes[static_cast<Index>(mesh.edge_nodes[edge][1])];
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

}  // namespace

template <class Real>
void Fdem<Real>::measure_cracks() {
  for (Index edge = 0; edge < body_.mesh.edge_nodes.size(); ++edge)
    if (body_.mesh.edge_kind[edge] == EdgeKind::crack) state_.ledger.crack_length += edge_length(body_.mesh, edge);
}

// Right triangle less left one at both ends of the edge, m.
template <class Real>
std::array<Real, 4> Fdem<Real>::opening_of(int joint) const {
  const Real *left = &scratch_.rows[static_cast<Index>(plan_.left_row[static_cast<Index>(joint)])],
             *right = &scratch_.rows[static_cast<Index>(plan_.right_row[static_cast<Index>(joint)])];
  return {right[2] - left[0], right[3] - left[1], right[0] - left[2], right[1] - left[3]};
}

template <class Real>
void Fdem<Real>::follow_stretched() {
  for (Index b = 0; b < scratch_.stretched.size(); ++b) {
    if (!scratch_.stretched[b]) continue;
    for (Index place = b * lanes; place < (b + 1) * lanes; ++place) {
      const int joint = scratch_.springs.joint_at[place];
      if (joint < 0) continue;
      const auto [ax, az, bx, bz] = opening_of(joint);
      if (std::max(ax * ax + az * az, bx * bx + bz * bz) > scratch_.reach[place]) follow(plan_, state_, scratch_, joint, {ax, az, bx, bz});
    }
  }
  if (is_unsettled(state_)) settle(plan_, state_, scratch_);
}

template <class Real>
void Fdem<Real>::note_breaks(double time) {
  for (int b = 0; b < scratch_.followed.blocks(); ++b) {
    if (!scratch_.breaks[static_cast<Index>(b)]) continue;
    for (int l = 0; l < lanes; ++l) {
      const Index at = static_cast<Index>(b) * 2 * lanes + static_cast<Index>(l);
      const int joint = scratch_.followed.joint_at[static_cast<Index>(b * lanes + l)];
      if (joint < 0 || state_.damage[at] < Real(1) || state_.damage[at + lanes] < Real(1)) continue;
      const Index edge = static_cast<Index>(plan_.edge_of[static_cast<Index>(joint)]);
      if (!std::isnan(state_.break_time[edge])) continue;
      state_.break_time[edge] = time, state_.break_mode[edge] = static_cast<unsigned char>(mode_of(joint));
      state_.ledger.crack_length += edge_length(body_.mesh, edge);
      expose(plan_.left_side[static_cast<Index>(joint)]), expose(plan_.right_side[static_cast<Index>(joint)]);
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
BreakMode Fdem<Real>::mode_of(int joint) const {
  const Index j = static_cast<Index>(joint), line = static_cast<Index>((joint / lanes) * 2 * lanes + joint % lanes);
  const Real *left = &scratch_.rows[static_cast<Index>(plan_.left_row[j])], *right = &scratch_.rows[static_cast<Index>(plan_.right_row[j])];
  double x = plan_.along[line], z = plan_.along[line + lanes];
  x += 0.5 * ((double(left[2]) - left[0]) + (double(right[0]) - right[2]));
  z += 0.5 * ((double(left[3]) - left[1]) + (double(right[1]) - right[3]));
  const auto [ax, az, bx, bz] = opening_of(joint);
  const auto& law = plan_.joint_laws[static_cast<Index>(plan_.joint_law_of_block[static_cast<Index>(joint / lanes)])];
  double opens = 0.0, slides = 0.0;
  for (const auto& [dx, dz] : {std::array<double, 2>{ax, az}, std::array<double, 2>{bx, bz}}) {
    const double n = std::max(0.0, dx * z - dz * x) * law.per_rupture_n, t = (dx * x + dz * z) * law.per_rupture_t;
    opens += n * n, slides += t * t;
  }
  const double share = opens / std::max(opens + slides, 1e-300);
  return share >= 0.75 ? BreakMode::tension : share <= 0.25 ? BreakMode::shear : BreakMode::mixed;
}

#define FRACFARM_INSTANTIATE(Real)               \
  template void Fdem<Real>::measure_cracks();    \
  template void Fdem<Real>::note_breaks(double); \
  template void Fdem<Real>::follow_stretched();  \
  template void Fdem<Real>::expose(int);         \
  template void Fdem<Real>::watch_side(int);     \
  template void Fdem<Real>::expose_cracks_that_close();
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
