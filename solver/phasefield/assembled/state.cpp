#include "solver/phasefield/assembled/state.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

// Equations of every element's unknowns, `per_node` for each node.
std::vector<int> element_equations(const Model& model, const std::vector<int>& equation, int per_node) {
  std::vector<int> all;
  for (int j = 0; j < model.grid.cells_z(); ++j)
    for (int i = 0; i < model.grid.cells_x(); ++i)
      for (const int n : model.nodes_of(i, j))
        for (int k = 0; k < per_node; ++k) all.push_back(equation[static_cast<std::size_t>(per_node * n + k)]);
  return all;
}

}  // namespace

State make_state(const Model& model) {
  State state;
  state.u = state.v = state.a = Vector::Zero(2 * model.nodes());
  state.psi = Vector::Zero(model.nodes());
  for (Eigen::Index n = 0; n < state.psi.size(); ++n) state.psi[n] = model.mask[static_cast<std::size_t>(n)];
  state.psi_previous = state.psi;
  state.history = model.first_history;
  if (model.yields) state.plastic.resize(state.history.size());
  return state;
}

Scratch make_scratch(const Model& model) {
  const std::size_t points = static_cast<std::size_t>(4 * model.elements());
  Scratch scratch;
  scratch.now.resize(points);
  scratch.before.resize(points);
  scratch.g.assign(points, 1.0);
  scratch.g_before.assign(points, 1.0);
  scratch.history.resize(points);
  scratch.force = scratch.force_before = scratch.u_before = Vector::Zero(2 * model.nodes());
  if (model.settings.integrator != Integrator::explicit_central)
    scratch.stiffness = SymmetricMatrix(element_equations(model, model.equation, 2), 8, model.equations);
  scratch.damage = SymmetricMatrix(element_equations(model, model.psi_equation, 1), 4, model.psi_equations);
  scratch.damage_source = Vector::Zero(model.psi_equations);
  return scratch;
}

}  // namespace fracfarm::phasefield::assembled
