#include "solver/phasefield/passes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fracfarm::phasefield {
namespace {

// Weights of the Chebyshev semi-iteration for a spectrum in [-radius, radius] (Golub and Varga, 1961).
class ChebyshevWeight {
 public:
  explicit ChebyshevWeight(double radius) : square_(radius * radius) {}
  double next() {
    const double given = weight_;
    weight_ = first_ ? 1.0 / (1.0 - 0.5 * square_) : 1.0 / (1.0 - 0.25 * square_ * weight_);
    first_ = false;
    return given;
  }

 private:
  double square_;
  double weight_ = 1.0;
  bool first_ = true;
};

template <class Real>
bool is_worked_on(const View<Real>& v, int j) {
  return v.run_begin[j] < v.run_begin[j + 1];
}

constexpr int most_planned = 8;   // sweeps of a step, where the model does not ask for more
constexpr int local_rounds = 32;  // of unsettled rows alone; what takes longer is left to Chebyshev

// The sweeps of one solve: they go to and fro between the guess, which stands in psi_previous, and another field.
template <class Real>
class Sweeps {
 public:
  Sweeps(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels)
      : state_(state),
        scratch_(scratch),
        unsettled_(scratch.unsettled_rows),
        kernels_(kernels),
        tolerance_(model.damage_tolerance),
        least_(model.damage_sweeps),
        local_(model.rules.sweep_where_it_moves),
        radius_(model.jacobi_radius),
        weight_(radius_) {
    const std::size_t at = model.grid.origin();
    fields_ = {state.psi_previous.data() + at, scratch.psi_other.data() + at};
  }

  // One more sweep over the rows, to be done row by row.
  void begin(bool last) {
    omega_[count_ % omega_.size()] = static_cast<Real>(weight_.next());
    last_ = last ? count_ : most_damage_sweeps;
    ++count_;
  }
  void row(const View<Real>& v, std::size_t sweep, int j) {
    const double change = kernels_.sweep(v, j, fields_[sweep % 2], fields_[1 - sweep % 2], omega_[sweep % omega_.size()], sweep == last_);
    if (sweep == last_) scratch_.change[static_cast<std::size_t>(j)] = change;
  }

  // More sweeps until every row is settled: of the unsettled rows and their neighbours where these are few, else of the whole grid.
  Result<void> settle(const View<Real>& v) {
    const std::size_t planned = count_;
    int rounds = 0;
    for (find_unsettled(); !unsettled_.empty(); ++rounds) {
      if (rounds >= damage_sweeps_limit) return trouble();
      if (local_ && rounds < local_rounds && 4 * static_cast<int>(unsettled_.size()) < v.rows)
        settle_rows(v);
      else
        sweep_grid(v);
    }
    plan(planned, rounds > 0);
    return keep();
  }

 private:
  // The next step's sweeps: as many of the grid as this step took, one less where the last of them was not needed. Sweeps that are planned
  // go row by row in the cache.
  void plan(std::size_t planned, bool settled_more) {
    const int made = static_cast<int>(count_) - (count_ == planned && !settled_more);
    state_.planned_sweeps = std::clamp(made, least_, std::max(least_, most_planned));
  }
  bool is_settled(int j) const { return scratch_.change[static_cast<std::size_t>(j)] <= tolerance_; }
  void find_unsettled() {
    unsettled_.clear();
    for (int j = 0; j < static_cast<int>(scratch_.change.size()); ++j)
      if (!is_settled(j)) unsettled_.push_back(j);
  }
  void settle_rows(const View<Real>& v) {
    std::vector<int>& near = scratch_.rows_near;
    near.clear();
    for (const int row : unsettled_)
      for (int j = std::max({row - 1, 0, near.empty() ? 0 : near.back() + 1}); j <= std::min(row + 1, v.rows - 1); ++j) near.push_back(j);
    unsettled_.clear();
    ++state_.sweeps;
    for (const int j : near) {
      if (!is_worked_on(v, j)) continue;
      scratch_.change[static_cast<std::size_t>(j)] = kernels_.settle(v, j, fields_[count_ % 2]);
      if (!is_settled(j)) unsettled_.push_back(j);
    }
    stale_ = true;
  }
  void sweep_grid(const View<Real>& v) {
    if (std::exchange(stale_, false)) weight_ = ChebyshevWeight(radius_);  // a new iteration: its first sweep needs one field only
    begin(true);
    for (int j = 0; j < v.rows; ++j)
      if (is_worked_on(v, j)) row(v, count_ - 1, j);
    find_unsettled();
  }
  // The fields take their places.
  Result<void> keep() {
    if (count_ % 2 == 1) std::swap(state_.psi_previous, scratch_.psi_other);
    std::swap(state_.psi, state_.psi_previous);
    state_.sweeps += static_cast<long long>(count_);
    ++scratch_.solves;
    if (state_.whole) scratch_.last_whole = scratch_.solves;
    return {};
  }
  tl::unexpected<Error> trouble() const {
    return fail(Fault::solver_numeric,
                fmt::format("the phase-field equation did not converge: correction {:.1e} after {} sweeps, limit {:.1e}",
                            *std::max_element(scratch_.change.begin(), scratch_.change.end()), damage_sweeps_limit, tolerance_));
  }

  State<Real>& state_;
  Scratch<Real>& scratch_;
  std::vector<int>& unsettled_;  // rows, from the bottom up
  const Kernels<Real>& kernels_;
  double tolerance_;
  int least_;
  bool local_;
  double radius_;
  ChebyshevWeight weight_;
  bool stale_ = false;  // rows were settled since the last sweep of the grid
  std::array<Real*, 2> fields_{};
  std::array<Real, most_damage_sweeps> omega_{};
  std::size_t count_ = 0;
  std::size_t last_ = 0;
};

// u += dt v and H. True where psi could have risen.
template <class Real>
bool move(const View<Real>& v, Scratch<Real>& scratch, const Kernels<Real>& kernels, Real dt) {
  bool damages = false;
  scratch.kept = 0.0;
  for (int front = 0; front <= v.rows; ++front) {
    if (front < v.rows) kernels.drift(v, front, dt);
    if (front == 0) continue;
    scratch.kept += kernels.history(v, front - 1);
    damages = damages || kernels.damages(v, front - 1, static_cast<Real>(least_damage));
  }
  return damages;
}

template <class Real>
Result<void> move_and_sweep(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, Real dt) {
  const View<Real> v = view(model, state, scratch);
  const std::size_t at = model.grid.origin();
  const Real* psi = state.psi.data() + at;
  Real* previous = state.psi_previous.data() + at;
  Sweeps<Real> sweeps(model, state, scratch, kernels);
  const int count = std::max(state.planned_sweeps, model.damage_sweeps);
  for (int k = 0; k < count; ++k) sweeps.begin(k + 1 == count);
  scratch.kept = 0.0;
  for (int front = 0; front < v.rows + count; ++front) {
    const auto is_due = [&](int j) { return j >= 0 && j < v.rows && is_worked_on(v, j); };
    if (front < v.rows) kernels.drift(v, front, dt);
    if (is_due(front)) kernels.guess(v, front, psi, previous);
    if (is_due(front - 1)) scratch.kept += kernels.history(v, front - 1);
    for (int k = 0; k < count; ++k)
      if (is_due(front - 1 - k)) sweeps.row(v, static_cast<std::size_t>(k), front - 1 - k);
  }
  return sweeps.settle(v);
}

// Laws that keep a part of the energy are worked on everywhere.
bool may_rest(const Model& model) { return model.rules.work_where_it_moves && (model.law == RowLaw::seed || model.law == RowLaw::none); }

// Tiles that hardly move are left as they are until the next whole step.
template <class Real>
void rest(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  const std::size_t at = model.grid.origin();
  for (int j = 0; j < v.rows; ++j) kernels.rest(v, j, state.psi.data() + at, state.psi_previous.data() + at, scratch.psi_other.data() + at);
  find_moving(model.grid, state, scratch);
  std::fill(scratch.change.begin(), scratch.change.end(), 0.0);
}

}  // namespace

template <class Real>
Result<void> move_and_damage(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, long long n,
                             double dt) {
  const Real step = static_cast<Real>(dt);
  if (state.damages && may_rest(model)) {
    const bool was_whole = std::exchange(state.whole, (n + 1) % rest_steps == 0);
    if (was_whole && !state.whole) rest(model, state, scratch, kernels);
  }
  if (state.damages || !model.rules.linear_until_damage) return move_and_sweep(model, state, scratch, kernels, step);
  state.damages = move(view(model, state, scratch), scratch, kernels, step);
  return state.damages ? solve_damage(model, state, scratch, kernels) : Result<void>{};
}

template <class Real>
void set_equation(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  for (int j = 0; j < v.rows; ++j) kernels.equation(v, j);
}

template <class Real>
void strain(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  for (int j = 0; j < v.rows; ++j) kernels.drift(v, j, Real(0));  // places the ghosts
  set_equation(model, state, scratch, kernels);
  scratch.kept = 0.0;
  for (int j = 0; j < v.rows; ++j) scratch.kept += kernels.history(v, j);
}

template <class Real>
Result<void> solve_damage(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  const std::size_t at = model.grid.origin();
  for (int j = 0; j < v.rows; ++j) kernels.guess(v, j, state.psi.data() + at, state.psi_previous.data() + at);
  std::fill(scratch.change.begin(), scratch.change.end(), INFINITY);
  return Sweeps<Real>(model, state, scratch, kernels).settle(v);
}

template <class Real>
StepSums respond(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels, double dt) {
  const View<Real> v = view(model, state, scratch);
  const std::size_t at = model.grid.origin();
  const Real *psi = state.psi.data() + at, *before = state.psi_previous.data() + at, step = static_cast<Real>(dt);
  Sums sums;
  int ready = 0;
  for (const auto [first, end] : scratch.tables.strips) {
    const int needed = std::min(end + 1, v.rows);
    kernels.degrade(v, ready, needed, psi, before, sums);
    kernels.force(v, ready, needed, sums);
    ready = needed;
    kernels.kick(v, first, end, step, sums);
  }
  scratch.released = sums.released.total();
  return {{sums.stress_xx.total(), sums.stress_zz.total()}, scratch.kept + sums.elastic.total(), sums.kinetic.total()};
}

template <class Real>
double elastic_energy(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  double energy = 0.0;
  for (int j = 0; j < v.rows; ++j) energy += kernels.elastic_energy(v, j);
  return energy;
}

template <class Real>
SurfaceSum surface(const Model& model, State<Real>& state, Scratch<Real>& scratch, const Kernels<Real>& kernels) {
  const View<Real> v = view(model, state, scratch);
  SurfaceParts sums;
  for (const auto [begin, end] : scratch.tables.surface_rows) kernels.surface(v, begin, end, state.psi.data() + model.grid.origin(), sums);
  return {sums.local.total(), sums.gradient.total(), sums.length.total()};
}

#define FRACFARM_INSTANTIATE(Real)                                                                                            \
  template Result<void> move_and_damage(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&, long long, double); \
  template void set_equation(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&);                               \
  template void strain(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&);                                     \
  template Result<void> solve_damage(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&);                       \
  template StepSums respond(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&, double);                        \
  template double elastic_energy(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&);                           \
  template SurfaceSum surface(const Model&, State<Real>&, Scratch<Real>&, const Kernels<Real>&);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::phasefield
