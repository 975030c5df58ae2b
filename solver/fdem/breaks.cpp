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

// Displacements of both sides.
template <class Real>
law::Ends<Real> Fdem<Real>::side_at(int row) const {
  const Real* u = &scratch_.rows[static_cast<Index>(row)];
  return {u[0], u[1], u[2], u[3]};
}

template <class Real>
EdgeNow<Real> Fdem<Real>::edge_now(int joint) const {
  const Index j = static_cast<Index>(joint);
  const law::Vector<Real> along{static_cast<Real>(plan_.along[in_block(j, 2, 0)]), static_cast<Real>(plan_.along[in_block(j, 2, 1)])};
  const law::Ends<Real> left = side_at(plan_.left_row[j]), right = side_at(plan_.right_row[j]);
  return {law::opening_between(left, right), law::midline(along, left, right)};
}

// A spring that softens is followed, as one that opened straight to where it is.
template <class Real>
void Fdem<Real>::follow_what_softens() {
  for (Index b = 0; b < scratch_.softens.size(); ++b) {
    if (!scratch_.softens[b]) continue;
    const law::Joint<Real>& law = model_.joint_laws[static_cast<Index>(scratch_.springs.law_of_block[b])];
    for (Index place = b * lanes; place < (b + 1) * lanes; ++place) {
      const int joint = scratch_.springs.joint_at[place];
      if (joint < 0) continue;
      const auto [opening, line] = edge_now(joint);
      if (!law::overstretched(law, opening, line)) continue;
      const double lambda = std::sqrt(static_cast<double>(law::largest_stretch(law, opening, line) / line.square));
      follow(plan_, state_, scratch_, joint, {opening.ax / lambda, opening.az / lambda, opening.bx / lambda, opening.bz / lambda});
    }
  }
}

template <class Real>
void Fdem<Real>::note_breaks(double time) {
  for (int b = 0; b < scratch_.followed.blocks(); ++b) {
    if (!scratch_.breaks[static_cast<Index>(b)]) continue;
    scratch_.breaks[static_cast<Index>(b)] = 0;
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
  const auto [opening, line] = edge_now(joint);
  const auto& law = plan_.joint_laws[static_cast<Index>(plan_.joint_law_of_block[static_cast<Index>(joint / lanes)])];
  double opens = 0.0, slides = 0.0;
  for (const law::Vector<Real>& end : {law::Vector<Real>{opening.ax, opening.az}, law::Vector<Real>{opening.bx, opening.bz}}) {
    const law::Opening<Real> parts = law::parts_of(end, line);
    const double n = std::max(0.0, static_cast<double>(parts.n)) * law.per_rupture_n, t = static_cast<double>(parts.t) * law.per_rupture_t;
    opens += n * n, slides += t * t;
  }
  const double share = opens / std::max(opens + slides, 1e-300);
  return share >= 0.75 ? BreakMode::tension : share <= 0.25 ? BreakMode::shear : BreakMode::mixed;
}

#define FRACFARM_INSTANTIATE(Real)                 \
  template void Fdem<Real>::measure_cracks();      \
  template void Fdem<Real>::note_breaks(double);   \
  template void Fdem<Real>::follow_what_softens(); \
  template void Fdem<Real>::expose(int);           \
  template void Fdem<Real>::watch_side(int);       \
  template void Fdem<Real>::expose_cracks_that_close();
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
