#include "solver/phasefield/model.hpp"

#include <algorithm>
#include <cmath>

#include "solver/phasefield/slots.hpp"

namespace fracfarm::phasefield {
namespace {

const Material& material_at(const Scene& scene, double z) {
  for (const Layer& layer : scene.layers)
    if (&layer == &scene.layers.back() || z < layer.below) return layer.material;
  return scene.layers.back().material;
}

double length_scale(const LengthScale& scale, const Material& material) {
  switch (scale.kind) {
    case LengthScale::Kind::half:
      return 0.5 * material.characteristic_width;
    case LengthScale::Kind::full:
      return material.characteristic_width;
    case LengthScale::Kind::metres:
      return scale.metres;
  }
  return scale.metres;
}

// Where a material may yield, its stiffness is written as the secant law writes it with s = 1, so that both agree to the last bit.
ElementRow element_row(const Material& material, const PhaseFieldSettings& settings) {
  const Elasticity& C = material.elasticity;
  ElementRow row{};
  row.stiffness = {C.C11, C.C13, C.C33, C.C55};
  row.plastic = settings.plasticity == PlasticityModel::secant && material.plasticity.has_value();
  if (row.plastic) {
    row.secant = law::secant(C.C13 + (2.0 / 3.0) * C.C55, C.C55, material.plasticity->yield, material.plasticity->hardening);
    row.stiffness = law::reduced_stiffness(row.secant, 1.0);
  }
  row.width = length_scale(settings.length_scale, material);
  row.surface = material.Gc / row.width;
  row.surface_slope = material.Gc * row.width;
  return row;
}

NodeRow node_row(const ElementRow& below, const ElementRow& above, const Grid& grid) {
  const double area = grid.corner_area();
  NodeRow row{};
  row.side = 2.0 * area * (below.surface_slope + above.surface_slope) / (grid.hx * grid.hx);
  row.south = 4.0 * area * below.surface_slope / (grid.hz * grid.hz);
  row.north = 4.0 * area * above.surface_slope / (grid.hz * grid.hz);
  row.diagonal = 2.0 * row.side + row.south + row.north + 2.0 * area * (below.surface + above.surface);
  return row;
}

void set_masses(Model& model, std::span<const double> density) {
  const Grid& grid = model.grid;
  model.mass = model.inverse_mass_x = model.inverse_mass_z = grid.field();
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i) {
      const double below = j > 0 ? density[static_cast<std::size_t>(j - 1)] : 0.0;
      const double above = j + 1 < grid.rows ? density[static_cast<std::size_t>(j)] : 0.0;
      const double corners = i == 0 || i + 1 == grid.columns ? 1.0 : 2.0;
      const std::size_t n = grid.index(i, j);
      model.mass[n] = corners * grid.corner_area() * (below + above);
      model.inverse_mass_x[n] = model.inverse_mass_z[n] = 1.0 / model.mass[n];
    }
}

SideNodes side_nodes(const Grid& grid) {
  SideNodes nodes;
  const auto add = [&](Side side, int count, double h, auto index) {
    for (int k = 0; k < count; ++k)
      nodes[static_cast<std::size_t>(side)].push_back(
          {index(k), k * h, k > 0 ? (k - 0.5) * h : 0.0, k + 1 < count ? (k + 0.5) * h : (count - 1) * h});
  };
  add(Side::left, grid.rows, grid.hz, [&](int k) { return grid.index(0, k); });
  add(Side::right, grid.rows, grid.hz, [&](int k) { return grid.index(grid.columns - 1, k); });
  add(Side::bottom, grid.columns, grid.hx, [&](int k) { return grid.index(k, 0); });
  add(Side::top, grid.columns, grid.hx, [&](int k) { return grid.index(k, grid.rows - 1); });
  return nodes;
}

void hold(Model& model) {
  for (const Motion& motion : model.boundary.motions)
    for (const std::size_t n : motion.nodes) (motion.axis == Axis::x ? model.inverse_mass_x : model.inverse_mass_z)[n] = 0.0;
}

void pin_cracks(Model& model, const Scene& scene) {
  model.mask = slot_mask(scene.cracks, model.grid);
  for (int j = 0; j < model.grid.rows; ++j)
    for (int i = 0; i < model.grid.columns; ++i)
      if (model.mask[static_cast<std::size_t>(j * model.grid.columns + i)]) model.pinned.push_back(model.grid.index(i, j));
}

}  // namespace

double stable_dt(const law::Stiffness<double>& C, double density, double hx, double hz) {
  const double x = C.C11 / (hx * hx) + C.C55 / (hz * hz);
  const double z = C.C33 / (hz * hz) + C.C55 / (hx * hx);
  return std::sqrt(density / std::max(x, z));
}

Model build_model(const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  Model model;
  model.grid = {settings.cells_x + 1, settings.cells_z + 1, scene.width / settings.cells_x, scene.height / settings.cells_z};
  const Grid& grid = model.grid;
  model.eta = settings.residual_stiffness;
  std::vector<double> density;
  model.stable_dt = INFINITY;
  for (int j = 0; j < grid.cells_z(); ++j) {
    const Material& material = material_at(scene, (j + 0.5) * grid.hz);
    model.element_rows.push_back(element_row(material, settings));
    density.push_back(material.density);
    model.stable_dt = std::min(model.stable_dt, stable_dt(model.element_rows.back().stiffness, material.density, grid.hx, grid.hz));
  }
  for (int j = 0; j < grid.rows; ++j) {
    const std::size_t above = static_cast<std::size_t>(std::min(j, grid.cells_z() - 1)),
                      below = static_cast<std::size_t>(std::max(j - 1, 0));
    model.node_rows.push_back(node_row(model.element_rows[below], model.element_rows[above], grid));
    const NodeRow& row = model.node_rows.back();
    model.jacobi_radius = std::max(model.jacobi_radius, (2.0 * row.side + row.south + row.north) / row.diagonal);
  }
  set_masses(model, density);
  model.boundary = build_boundary(scene, side_nodes(grid));
  hold(model);
  pin_cracks(model, scene);
  return model;
}

}  // namespace fracfarm::phasefield
