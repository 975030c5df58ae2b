#include "solver/phasefield/state.hpp"

namespace fracfarm::phasefield {

State make_state(const Model& model) {
  const Field zero = model.grid.field();
  State state{zero, zero, zero, zero, {zero, zero, zero, zero}, zero, zero};
  for (const std::size_t n : model.pinned) state.psi[n] = state.psi_previous[n] = 1.0;
  return state;
}

Scratch make_scratch(const Model& model) {
  const Field zero = model.grid.field();
  Scratch scratch{};
  for (Field* field : {&scratch.source, &scratch.inverse_diagonal, &scratch.stored, &scratch.stored_before, &scratch.g, &scratch.fx,
                       &scratch.fz, &scratch.psi_other})
    *field = zero;
  scratch.reduction.fill(zero);
  scratch.row_yields.assign(static_cast<std::size_t>(model.grid.cells_z()), 0);
  scratch.rows.assign(static_cast<std::size_t>(scratch_rows * model.grid.stride()), 0.0);
  std::size_t held = 0;
  for (const Motion& motion : model.boundary.motions) held += motion.nodes.size();
  scratch.held_force.assign(held, 0.0);
  return scratch;
}

View view(const Model& model, State& state, Scratch& scratch) {
  const Grid& grid = model.grid;
  const std::size_t at = grid.origin();
  View v{};
  v.columns = grid.columns, v.rows = grid.rows, v.padded = grid.padded_columns(), v.stride = grid.stride();
  v.hx = grid.hx, v.hz = grid.hz, v.corner_area = grid.corner_area(), v.eta = model.eta;
  v.element_rows = model.element_rows.data(), v.node_rows = model.node_rows.data();
  v.mass = model.mass.data() + at;
  v.inverse_mass_x = model.inverse_mass_x.data() + at, v.inverse_mass_z = model.inverse_mass_z.data() + at;
  v.ux = state.ux.data() + at, v.uz = state.uz.data() + at, v.vx = state.vx.data() + at, v.vz = state.vz.data() + at;
  for (std::size_t k = 0; k < 4; ++k) v.history[k] = state.history[k].data() + at, v.reduction[k] = scratch.reduction[k].data() + at;
  v.row_yields = scratch.row_yields.data();
  v.source = scratch.source.data() + at, v.inverse_diagonal = scratch.inverse_diagonal.data() + at;
  v.stored = scratch.stored.data() + at, v.stored_before = scratch.stored_before.data() + at;
  v.g = scratch.g.data() + at;
  v.fx = scratch.fx.data() + at, v.fz = scratch.fz.data() + at;
  v.scratch = scratch.rows.data() + lanes;
  return v;
}

}  // namespace fracfarm::phasefield
