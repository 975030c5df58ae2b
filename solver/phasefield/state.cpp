#include "solver/phasefield/state.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace fracfarm::phasefield {
namespace {

template <class Real>
Differenced<Real> converted(const Differenced<double>& d) {
  const auto to = [](double value) { return static_cast<Real>(value); };
  return {to(d.c11), to(d.c33), to(d.c13), to(d.c55), to(d.shear)};
}

template <class Real>
Yielding<Real> converted(const Yielding<double>& y) {
  const auto to = [](double value) { return static_cast<Real>(value); };
  return {to(y.normal_x), to(y.normal_z), to(y.cross), to(y.shear), to(y.soft), to(y.drive), to(y.energy)};
}

template <class Real>
ElementRow<Real> converted(const ElementRow<double>& row) {
  const auto to = [](double value) { return static_cast<Real>(value); };
  const law::Stiffness<double>& C = row.stiffness;
  return {{to(C.C11), to(C.C13), to(C.C33), to(C.C55)},
          row.plastic,
          converted<Real>(row.energy),
          converted<Real>(row.force),
          converted<Real>(row.yielding),
          to(row.lambda),
          to(row.mu),
          to(row.per_dimensions),
          to(row.star_convexity),
          to(row.surface_square),
          to(row.surface_linear),
          to(row.surface_gradient),
          to(row.surface_length)};
}

template <class Real>
NodeRow<Real> converted(const NodeRow<double>& row) {
  const auto to = [](double value) { return static_cast<Real>(value); };
  return {to(row.side),      to(row.south), to(row.north), to(row.diagonal), to(row.weight),
          to(row.threshold), to(row.mass),  row.amid,      to(row.along_x),  to(row.along_z)};
}

// Pointers to column 0 of each row of a field of inverse masses; rows that are equal share one copy, which then stays in the cache.
template <class Real>
std::vector<const Real*> shared_rows(const Grid& grid, const Field<double>& field, std::vector<Field<Real>>& store) {
  std::vector<const Real*> rows;
  for (int j = 0; j < grid.rows; ++j) {
    Field<Real> row(static_cast<std::size_t>(grid.padded_columns()), Real(0));
    for (int i = 0; i < grid.columns; ++i) row[static_cast<std::size_t>(i)] = static_cast<Real>(field[grid.index(i, j)]);
    const auto same = std::find(store.rbegin(), store.rend(), row);
    rows.push_back(same != store.rend() ? same->data() : store.emplace_back(std::move(row)).data());
  }
  return rows;
}

int row_of(const Grid& grid, std::size_t index) {
  return static_cast<int>((index - grid.origin()) / static_cast<std::size_t>(grid.stride()));
}
int column_of(const Grid& grid, std::size_t index) {
  return static_cast<int>((index - grid.origin()) % static_cast<std::size_t>(grid.stride()));
}

// Where each row's entries begin in a list that is sorted by row.
std::vector<int> row_begins(const Grid& grid, const std::vector<std::size_t>& sorted) {
  std::vector<int> begins(static_cast<std::size_t>(grid.rows) + 1, 0);
  for (const std::size_t n : sorted) ++begins[static_cast<std::size_t>(row_of(grid, n)) + 1];
  for (std::size_t j = 1; j < begins.size(); ++j) begins[j] += begins[j - 1];
  return begins;
}

// Neighbouring rows among elements of one kind and of the same masses, as many as go together; other rows by themselves.
template <class Real>
std::vector<Run> strips_of(const Model& model, const Tables<Real>& tables) {
  const auto alike = [&](std::size_t a, std::size_t b) {
    const NodeRow<double>&south = model.node_rows[a], &north = model.node_rows[b];
    return south.amid && north.amid && south.mass == north.mass && tables.inverse_mass_x[a] == tables.inverse_mass_x[b] &&
           tables.inverse_mass_z[a] == tables.inverse_mass_z[b];
  };
  std::vector<Run> strips;
  for (int j = 0; j < model.grid.rows; ++j)
    if (j > 0 && alike(static_cast<std::size_t>(j - 1), static_cast<std::size_t>(j)) &&
        strips.back().end - strips.back().begin < strip_rows)
      ++strips.back().end;
    else
      strips.push_back({j, j + 1});
  return strips;
}

bool same_surface(const ElementRow<double>& a, const ElementRow<double>& b) {
  return a.surface_square == b.surface_square && a.surface_linear == b.surface_linear && a.surface_gradient == b.surface_gradient &&
         a.surface_length == b.surface_length;
}

// As many neighbouring rows as may go into one sum of Reals.
std::vector<Run> surface_rows_of(const Model& model) {
  constexpr int most = 8;
  std::vector<Run> runs;
  for (int j = 0; j < model.grid.rows; ++j) {
    const ElementRow<double>* rows = model.element_rows.data() + j;
    if (j > 0 && runs.back().end - runs.back().begin < most && same_surface(rows[0], rows[-1]) && same_surface(rows[1], rows[0]))
      ++runs.back().end;
    else
      runs.push_back({j, j + 1});
  }
  return runs;
}

template <class Real>
Tables<Real> make_tables(const Model& model) {
  const Grid& grid = model.grid;
  Tables<Real> tables;
  for (const ElementRow<double>& row : model.element_rows) tables.element_rows.push_back(converted<Real>(row));
  for (const NodeRow<double>& row : model.node_rows) tables.node_rows.push_back(converted<Real>(row));
  tables.column_weight.assign(static_cast<std::size_t>(grid.padded_columns()), Real(0));
  std::fill_n(tables.column_weight.begin(), grid.columns, Real(1));
  tables.column_weight.front() = tables.column_weight[static_cast<std::size_t>(grid.columns - 1)] = Real(0.5);
  tables.inverse_mass_x = shared_rows(grid, model.inverse_mass_x, tables.inverse_masses);
  tables.inverse_mass_z = shared_rows(grid, model.inverse_mass_z, tables.inverse_masses);
  for (int j = 0; j <= grid.rows; ++j) tables.whole_rows.begin.push_back(j);
  tables.whole_rows.runs.assign(static_cast<std::size_t>(grid.rows), Run{0, grid.padded_columns()});
  tables.strips = strips_of(model, tables);
  tables.surface_rows = surface_rows_of(model);
  std::vector<std::size_t> pinned = model.pinned, pulled;
  std::sort(pinned.begin(), pinned.end());
  tables.pin_begin = row_begins(grid, pinned);
  for (const std::size_t n : pinned) tables.pins.push_back(column_of(grid, n));
  tables.whole = grid.field<Real>();
  for (int j = 0; j < grid.rows; ++j)
    std::fill_n(tables.whole.begin() + static_cast<std::ptrdiff_t>(grid.index(0, j)), grid.columns, Real(1));
  for (const std::size_t n : pinned) tables.whole[n] = Real(0);
  for (const Traction& traction : model.boundary.tractions) pulled.insert(pulled.end(), traction.nodes.begin(), traction.nodes.end());
  std::sort(pulled.begin(), pulled.end());
  pulled.erase(std::unique(pulled.begin(), pulled.end()), pulled.end());
  tables.node_force_begin = row_begins(grid, pulled);
  for (const std::size_t n : pulled) tables.node_forces.push_back({column_of(grid, n), Real(0), Real(0)});
  return tables;
}

}  // namespace

double Parts::total() const {
  double eight[8], four[4];
  for (int l = 0; l < 8; ++l) eight[l] = at[l] + at[l + 8];
  for (int l = 0; l < 4; ++l) four[l] = eight[l] + eight[l + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
}

template <class Real>
State<Real> make_state(const Model& model) {
  const Grid& grid = model.grid;
  const Field<Real> zero = grid.field<Real>();
  State<Real> state;
  for (Field<Real>* field : {&state.ux, &state.uz, &state.vx, &state.vz, &state.psi, &state.psi_previous}) *field = zero;
  state.history.fill(zero);
  state.stored = zero;
  const std::size_t tiles = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.tiles());
  state.moves.assign(tiles, 1), state.yields.assign(tiles, 0);
  for (const std::size_t n : model.pinned) state.psi[n] = state.psi_previous[n] = Real(1);
  for (int j = 0; j < grid.cells_z() && !model.first_history.empty(); ++j)
    for (int i = 0; i < grid.cells_x(); ++i) {
      const Real first = static_cast<Real>(model.first_history[static_cast<std::size_t>(j * grid.cells_x() + i)]);
      for (int corner = 0; corner < 4; ++corner) set_history(grid, state, i, j, corner, first);
    }
  return state;
}

template <class Real>
Scratch<Real> make_scratch(const Model& model) {
  const Field<Real> zero = model.grid.field<Real>();
  Scratch<Real> scratch;
  scratch.tables = make_tables<Real>(model);
  for (Field<Real>* field : {&scratch.source, &scratch.inverse_diagonal, &scratch.stored_before, &scratch.degradation, &scratch.fx,
                             &scratch.fz, &scratch.psi_other})
    *field = zero;
  scratch.moving.begin.reserve(static_cast<std::size_t>(model.grid.rows) + 1);  // the most that find_moving() needs: every other tile
  scratch.moving.runs.reserve(static_cast<std::size_t>(model.grid.rows) * static_cast<std::size_t>(model.grid.tiles() / 2 + 1));
  scratch.gives.assign((static_cast<std::size_t>(model.grid.rows) + 2) * static_cast<std::size_t>(model.grid.tiles()), gives_nothing);
  scratch.change.assign(static_cast<std::size_t>(model.grid.rows), 0.0);
  for (std::vector<int>* rows : {&scratch.unsettled_rows, &scratch.rows_near}) rows->reserve(static_cast<std::size_t>(model.grid.rows));
  scratch.rows.assign(static_cast<std::size_t>(scratch_rows * model.grid.stride() + lanes), Real(0));
  scratch.held_force.assign(model.boundary.motions.size(), 0.0);
  scratch.held_velocity.assign(model.boundary.motions.size(), std::numeric_limits<Real>::quiet_NaN());
  return scratch;
}

template <class Real>
void find_moving(const Grid& grid, State<Real>& state, Scratch<Real>& scratch) {
  RunList& list = scratch.moving;
  list.begin.assign(1, 0), list.runs.clear();
  for (int j = 0; j < grid.rows; ++j) {
    unsigned char* moves = state.moves.data() + static_cast<std::ptrdiff_t>(j) * grid.tiles();
    const bool some = std::memchr(moves, 1, static_cast<std::size_t>(grid.tiles())) != nullptr;
    for (int t = 0; t < grid.tiles() && some; ++t) {
      if (!moves[t]) continue;
      const bool first = static_cast<int>(list.runs.size()) == list.begin.back();
      if (first || t * lanes > list.runs.back().end + lanes)
        list.runs.push_back({t * lanes, (t + 1) * lanes});
      else
        moves[t - 1] = 1, list.runs.back().end = (t + 1) * lanes;
    }
    list.begin.push_back(static_cast<int>(list.runs.size()));
  }
}

template <class Real>
View<Real> view(const Model& model, State<Real>& state, Scratch<Real>& scratch) {
  const Grid& grid = model.grid;
  const Tables<Real>& tables = scratch.tables;
  const std::size_t at = grid.origin();
  View<Real> v{};
  v.columns = grid.columns, v.rows = grid.rows, v.padded = grid.padded_columns(), v.stride = grid.stride(), v.tiles = grid.tiles();
  v.hx = grid.hx, v.hz = grid.hz, v.corner_area = grid.corner_area(), v.eta = static_cast<Real>(model.eta);
  v.law = model.law, v.keeps_forces = model.keeps_forces;
  v.tests_yield = model.rules.plastic_where_it_yields;
  const RunList& work = state.whole ? tables.whole_rows : scratch.moving;
  v.run_begin = work.begin.data(), v.runs = work.runs.data();
  v.moved_damage = static_cast<Real>(model.moved_damage);
  v.moves = state.moves.data();
  v.yields = state.yields.data();
  v.element_rows = tables.element_rows.data(), v.node_rows = tables.node_rows.data();
  v.column_weight = tables.column_weight.data();
  v.whole_nodes = tables.whole.data() + at;
  v.inverse_mass_x = tables.inverse_mass_x.data(), v.inverse_mass_z = tables.inverse_mass_z.data();
  v.pin_begin = tables.pin_begin.data(), v.pins = tables.pins.data();
  v.node_force_begin = tables.node_force_begin.data(), v.node_forces = tables.node_forces.data();
  v.ux = state.ux.data() + at, v.uz = state.uz.data() + at, v.vx = state.vx.data() + at, v.vz = state.vz.data() + at;
  for (std::size_t k = 0; k < 4; ++k) v.history[k] = state.history[k].data() + at;
  v.source = scratch.source.data() + at, v.inverse_diagonal = scratch.inverse_diagonal.data() + at;
  v.stored = state.stored.data() + at, v.stored_before = scratch.stored_before.data() + at;
  v.degradation = scratch.degradation.data() + at;
  v.gives = scratch.gives.data() + grid.tiles();
  v.fx = scratch.fx.data() + at, v.fz = scratch.fz.data() + at;
  v.scratch = scratch.rows.data() + lanes;
  return v;
}

template <class Real>
NodeForce<Real>& node_force(const Grid& grid, Tables<Real>& tables, std::size_t index) {
  const std::size_t row = static_cast<std::size_t>(row_of(grid, index));
  const auto begin = tables.node_forces.begin();
  return *std::lower_bound(begin + tables.node_force_begin[row], begin + tables.node_force_begin[row + 1], column_of(grid, index),
                           [](const NodeForce<Real>& force, int column) { return force.column < column; });
}

// A node's quadrant lies opposite to the corner of its element; at the sides the outer quadrants mirror the inner ones.
template <class Real>
void set_history(const Grid& grid, State<Real>& state, int column, int row, int corner, Real value) {
  const int i = column + corner % 2;
  const std::size_t n = grid.index(i, row + corner / 2), quadrant = static_cast<std::size_t>(3 - corner);
  state.history[quadrant][n] = value;
  if (i == 0 || i == grid.columns - 1) state.history[quadrant ^ 1][n] = value;
}

template <class Real>
Real history_at(const Grid& grid, const State<Real>& state, int column, int row, int corner) {
  return state.history[static_cast<std::size_t>(3 - corner)][grid.index(column + corner % 2, row + corner / 2)];
}

#define FRACFARM_INSTANTIATE(Real)                                               \
  template State<Real> make_state(const Model&);                                 \
  template Scratch<Real> make_scratch(const Model&);                             \
  template void find_moving(const Grid&, State<Real>&, Scratch<Real>&);          \
  template View<Real> view(const Model&, State<Real>&, Scratch<Real>&);          \
  template NodeForce<Real>& node_force(const Grid&, Tables<Real>&, std::size_t); \
  template void set_history(const Grid&, State<Real>&, int, int, int, Real);     \
  template Real history_at(const Grid&, const State<Real>&, int, int, int);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::phasefield
