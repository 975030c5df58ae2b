#include "solver/phasefield/model.hpp"

#include <algorithm>
#include <cmath>

#include "solver/law/secant.hpp"
#include "solver/phasefield/domain.hpp"
#include "solver/phasefield/slots.hpp"

namespace fracfarm::phasefield {
namespace {

// The last correction of psi may be this, and less where w_0 is more than h: the error of psi is at most radius / (1 - radius) times it and
// stays below 2.5e-4, because records refuse a psi that heals by 5e-4. What it moves against 1e-9: see ACCURACY.md.
constexpr double damage_tolerance = 5e-5, damage_error = 2.5e-4;
// In layers of several materials a correction says less of the error, psi healed by up to 9e-4; there, and past w_0 = 2.5 h, it is this.
// Near a radius of 1 a broad zone healed by the error's bound.
constexpr double broad_tolerance = 1e-5, broad_error = 6.5e-4;
// What psi may move by in rest_steps steps, and the tile rests. A zone narrower than a cell shows less of itself before it is there: with
// 4e-4 a through crack of tungsten came up to 12 % apart.
constexpr double moved_damage = 4e-4, moved_damage_narrow = 1e-4;
// Corrections in float do not get below the last.
constexpr double least_tolerance = 1e-12, least_tolerance_float = 5e-7;
// What the sweeps of the whole grid should leave of the guess's error.
constexpr double sweeps_reduction = 0.5;

RowLaw row_law(Split split) {
  switch (split) {
    case Split::seed:
      return RowLaw::seed;
    case Split::none:
      return RowLaw::none;
    case Split::spectral:
      return RowLaw::spectral;
    case Split::volumetric_deviatoric:
    case Split::star_convex:
      return RowLaw::star_convex;
  }
  return RowLaw::seed;
}

Differenced<double> differenced(const law::Stiffness<double>& C, double x, double z, double by) {
  return {by * C.C11 * x * x, by * C.C33 * z * z, by * C.C13 * x * z, by * C.C55 * z * z, by * C.C55 * x * z};
}

Yielding<double> yielding(const law::Secant<double>& law, double x, double z) {
  const double soft = 1.0 - law.hardening_share, unit = 6.0 * law.mu * law.mu / (law.yield * law.yield);
  return {2.0 / 3.0 * unit * x * x,
          2.0 / 3.0 * unit * z * z,
          2.0 / 3.0 * unit * x * z,
          0.5 * unit * z * z,
          soft,
          soft * law.mu / unit,
          soft * law.yield * law.yield / (6.0 * law.mu)};
}

// Where a material may yield, its stiffness is written as the secant law writes it with s = 1.
void set_elasticity(ElementRow<double>& row, const Material& material, const PhaseFieldSettings& settings, const Grid& grid) {
  const Elasticity& C = material.elasticity;
  const double x = 1.0 / grid.hx, z = 1.0 / grid.hz;
  row.stiffness = stiffness_of(material, settings);
  row.plastic = settings.plasticity == PlasticityModel::secant && material.plasticity.has_value();
  if (row.plastic) {
    const auto secant = law::secant(C.C13 + (2.0 / 3.0) * C.C55, C.C55, material.plasticity->yield, material.plasticity->hardening);
    row.stiffness = law::reduced_stiffness(secant, 1.0);
    row.yielding = yielding(secant, x, z);
  }
  row.energy = differenced(row.stiffness, x, z, 0.5);
  row.energy.c13 *= 2.0;
  row.force = differenced(row.stiffness, x, z, grid.corner_area());
  row.lambda = row.stiffness.C13, row.mu = row.stiffness.C55;
  row.per_dimensions = settings.plane == Plane::stress ? 1.0 / 2.0 : 1.0 / 3.0;
  row.star_convexity = star_convexity(settings);
}

void set_surface(ElementRow<double>& row, const Material& material, const PhaseFieldSettings& settings) {
  const double width = length_scale(material, settings), Gc = material.Gc;
  const bool at1 = settings.surface == SurfaceModel::at1;
  row.surface_square = at1 ? 0.0 : 0.5 * Gc / width;
  row.surface_linear = at1 ? 0.375 * Gc / width : 0.0;
  row.surface_gradient = at1 ? 0.375 * Gc * width : 0.5 * Gc * width;
  row.surface_length = 2.0 * row.surface_gradient / Gc;  // the gradient's part is half the energy of a crack in both
}

// What a row of nodes gets from the elements below and above it; beyond the ends these are mirrored.
NodeRow<double> node_row(const law::SurfaceLaw<double>& below, const law::SurfaceLaw<double>& above, bool at_end, const Grid& grid) {
  const double area = grid.corner_area();
  NodeRow<double> row;
  row.side = 2.0 * area * (below.slope + above.slope) / (grid.hx * grid.hx);
  row.south = 4.0 * area * below.slope / (grid.hz * grid.hz);
  row.north = 4.0 * area * above.slope / (grid.hz * grid.hz);
  row.diagonal = 2.0 * row.side + row.south + row.north + 2.0 * area * (below.mass + above.mass);
  row.weight = at_end ? 4.0 * area : 2.0 * area;  // at an end the quadrants outside hold nothing
  row.threshold = 2.0 * area * (below.threshold + above.threshold);
  return row;
}

bool is_of_one_surface(const Scene& scene) {
  const Material& first = scene.layers.front().material;
  return std::all_of(scene.layers.begin(), scene.layers.end(), [&](const Layer& layer) {
    return layer.material.Gc == first.Gc && layer.material.characteristic_width == first.characteristic_width;
  });
}

bool is_narrow(const Scene& scene, const Grid& grid) {
  return std::any_of(scene.layers.begin(), scene.layers.end(),
                     [&](const Layer& layer) { return length_scale(layer.material, scene.phase_field) < std::max(grid.hx, grid.hz); });
}

double tolerance_of(double radius, Precision precision, bool one_surface) {
  const double least = precision == Precision::float_ ? least_tolerance_float : least_tolerance;
  const double narrow = one_surface ? std::min(damage_tolerance, damage_error * (1.0 - radius)) : 0.0;
  const double broad = std::min(broad_tolerance, broad_error * (1.0 - radius));
  return std::max({least, narrow, broad});
}

double jacobi_radius(const NodeRow<double>& row, const law::SurfaceLaw<double>& below, const law::SurfaceLaw<double>& above, double area) {
  const double neighbours = 2.0 * row.side + row.south + row.north;
  return neighbours / (row.diagonal + 4.0 * area * (below.floor + above.floor));
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
      if (i == 0) model.node_rows[static_cast<std::size_t>(j)].mass = 2.0 * model.mass[n];
    }
}

void hold(Model& model) {
  for (const Motion& motion : model.boundary.motions)
    for (const std::size_t n : motion.nodes) (motion.axis == Axis::x ? model.inverse_mass_x : model.inverse_mass_z)[n] = 0.0;
}

void seed_history(Model& model, const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  if (settings.crack_seeding != CrackSeeding::history && settings.surface != SurfaceModel::at1) return;
  const std::vector<unsigned char> seeded = seeded_elements(settings.crack_seeding, scene.cracks, model.grid);
  for (int j = 0; j < model.grid.cells_z(); ++j) {
    const Material& material = material_at(scene, (j + 0.5) * model.grid.hz);
    const double width = length_scale(material, settings);
    const double crack = seeded_history(material.Gc, width), floor = surface_law(material, settings).floor;
    for (int i = 0; i < model.grid.cells_x(); ++i)
      model.first_history.push_back(seeded[static_cast<std::size_t>(j * model.grid.cells_x() + i)] ? crack : floor);
  }
}

void pin_cracks(Model& model, const Scene& scene) {
  model.mask = held_mask(scene.phase_field.crack_seeding, scene.cracks, model.grid);
  for (int j = 0; j < model.grid.rows; ++j)
    for (int i = 0; i < model.grid.columns; ++i)
      if (model.mask[static_cast<std::size_t>(j * model.grid.columns + i)]) model.pinned.push_back(model.grid.index(i, j));
}

// Chebyshev sweeps that reduce an error as asked, for this spectral radius.
int sweeps_of(double radius) {
  const double rate = radius > 0.0 ? (1.0 - std::sqrt(1.0 - radius * radius)) / radius : 0.0;
  const double count = rate > 0.0 ? std::log(0.5 * sweeps_reduction) / std::log(rate) : 1.0;
  return static_cast<int>(std::clamp(std::ceil(count), 1.0, 1.0 * most_damage_sweeps));
}

bool same(const law::Stiffness<double>& a, const law::Stiffness<double>& b) {
  return a.C11 == b.C11 && a.C13 == b.C13 && a.C33 == b.C33 && a.C55 == b.C55;
}

void set_rows(Model& model, const Scene& scene) {
  const Grid& grid = model.grid;
  const std::size_t cells = static_cast<std::size_t>(grid.cells_z());
  std::vector<double> density;
  std::vector<law::SurfaceLaw<double>> surface;
  model.element_rows.resize(cells + 2);
  model.stable_dt = INFINITY;
  for (std::size_t j = 0; j < cells; ++j) {
    const Material& material = material_at(scene, (static_cast<double>(j) + 0.5) * grid.hz);
    ElementRow<double>& row = model.element_rows[j + 1];
    set_elasticity(row, material, scene.phase_field, grid);
    set_surface(row, material, scene.phase_field);
    surface.push_back(surface_law(material, scene.phase_field));
    density.push_back(material.density);
    model.stable_dt = std::min(model.stable_dt, stable_dt(row.stiffness, material.density, scene.phase_field, grid));
  }
  for (std::size_t j = 0; j <= cells; ++j) {
    const law::SurfaceLaw<double>&below = surface[j > 0 ? j - 1 : 0], &above = surface[std::min(j, cells - 1)];
    model.node_rows.push_back(node_row(below, above, j == 0 || j == cells, grid));
    NodeRow<double>& row = model.node_rows.back();
    const ElementRow<double>&south = model.element_rows[j], &north = model.element_rows[j + 1];
    const double ratio = grid.hz / grid.hx;
    row.along_x = south.force.c11 + north.force.c11, row.along_z = ratio * ratio * (south.force.c55 + north.force.c55);
    row.amid = same(south.stiffness, north.stiffness);
    model.jacobi_radius = std::max(model.jacobi_radius, jacobi_radius(model.node_rows.back(), below, above, grid.corner_area()));
  }
  set_masses(model, density);
}

}  // namespace

Model build_model(const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  Model model;
  model.grid = make_grid(scene);
  model.eta = settings.residual_stiffness;
  model.law = row_law(settings.split);
  set_rows(model, scene);
  model.damage_tolerance = tolerance_of(model.jacobi_radius, settings.precision, is_of_one_surface(scene));
  model.moved_damage = is_narrow(scene, model.grid) ? moved_damage_narrow : moved_damage;
  model.damage_sweeps = sweeps_of(model.jacobi_radius);
  model.boundary = build_boundary(scene, side_nodes(model.grid, [&](int column, int row) { return model.grid.index(column, row); }));
  hold(model);
  pin_cracks(model, scene);
  seed_history(model, scene);
  return model;
}

}  // namespace fracfarm::phasefield
