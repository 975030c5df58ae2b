#include "solver/phasefield/assembled/model.hpp"

#include <algorithm>
#include <cmath>

#include "solver/phasefield/domain.hpp"
#include "solver/phasefield/slots.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

ElementRow element_row(const Material& material, const PhaseFieldSettings& settings) {
  return {make_law(material, settings), surface_law(material, settings), material.Gc, length_scale(material, settings), material.density};
}

void set_rows(Model& model, const Scene& scene) {
  model.mass = Vector::Zero(2 * model.nodes());
  model.stable_dt = INFINITY;
  for (int j = 0; j < model.grid.cells_z(); ++j) {
    const Material& material = material_at(scene, (j + 0.5) * model.grid.hz);
    model.element_rows.push_back(element_row(material, model.settings));
    model.linear = model.linear && is_linear(model.element_rows.back().law);
    model.yields = model.yields || std::holds_alternative<PlasticLaw>(model.element_rows.back().law);
    model.stable_dt = std::min(model.stable_dt,
                               phasefield::stable_dt(stiffness_of(material, model.settings), material.density, model.settings, model.grid));
    for (int i = 0; i < model.grid.cells_x(); ++i)
      for (const int n : model.nodes_of(i, j))
        for (const int axis : {0, 1}) model.mass[2 * n + axis] += model.element.weight * material.density;
  }
}

// Directions of rigid motion (two shifts and a turn) that held displacements take away.
class RigidMotions {
 public:
  explicit RigidMotions(const Grid& grid) : grid_(grid) {}

  // True where holding this displacement takes a motion away that was still free.
  bool take(std::size_t displacement) {
    const int node = static_cast<int>(displacement / 2), size = std::max(grid_.columns, grid_.rows);
    const double x = static_cast<double>(node % grid_.columns) / size, z = static_cast<double>(node / grid_.columns) / size;
    Eigen::Vector3d motion = displacement % 2 == 0 ? Eigen::Vector3d(1.0, 0.0, -z) : Eigen::Vector3d(0.0, 1.0, x);
    for (const Eigen::Vector3d& taken : taken_) motion -= taken.dot(motion) * taken;
    if (motion.norm() < 1e-9) return false;
    taken_.push_back(motion.normalized());
    return true;
  }
  bool all_taken() const { return taken_.size() == 3; }

 private:
  const Grid& grid_;
  std::vector<Eigen::Vector3d> taken_;
};

// A body without inertia needs a place: corners are held where the loads leave a rigid motion free.
void support(Model& model, std::vector<bool>& held) {
  RigidMotions motions(model.grid);
  for (std::size_t d = 0; d < held.size() && !motions.all_taken(); ++d)
    if (held[d]) motions.take(d);
  const int corner = model.node(0, 0), right = model.node(model.grid.columns - 1, 0), top = model.node(0, model.grid.rows - 1);
  for (const int candidate : {2 * corner, 2 * corner + 1, 2 * right + 1, 2 * top}) {
    const auto d = static_cast<std::size_t>(candidate);
    if (motions.all_taken() || held[d] || !motions.take(d)) continue;
    held[d] = true;
    model.supports.push_back(d);
  }
}

void number_equations(Model& model) {
  std::vector<bool> held(static_cast<std::size_t>(2 * model.nodes()), false);
  for (const Motion& motion : model.boundary.motions)
    for (const std::size_t n : motion.nodes) held[2 * n + (motion.axis == Axis::z)] = true;
  for (const Told& told : model.prescription.told)
    held[static_cast<std::size_t>(2 * model.node(told.column, told.row) + (told.axis == Axis::z))] = true;
  if (model.settings.integrator == Integrator::quasi_static) support(model, held);
  for (const bool is_held : held) model.equation.push_back(is_held ? -1 : model.equations++);
  for (const unsigned char is_held : model.mask) model.psi_equation.push_back(is_held ? -1 : model.psi_equations++);
}

void seed_history(Model& model, const Scene& scene) {
  const std::vector<unsigned char> seeded = seeded_elements(model.settings.crack_seeding, scene.cracks, model.grid);
  for (std::size_t e = 0; e < seeded.size(); ++e) {
    const ElementRow& row = model.element_rows[e / static_cast<std::size_t>(model.grid.cells_x())];
    model.first_history.insert(model.first_history.end(), 4, seeded[e] ? seeded_history(row.Gc, row.width) : row.surface.floor);
  }
}

}  // namespace

Model build_model(const Scene& scene, Prescription prescription) {
  Model model;
  model.settings = scene.phase_field;
  const PhaseFieldSettings& settings = model.settings;
  model.grid = make_grid(scene);
  model.element = make_element(settings.quadrature, model.grid.hx, model.grid.hz);
  set_rows(model, scene);
  model.boundary = build_boundary(scene, side_nodes(model.grid, [&](int column, int row) { return model.node(column, row); }));
  model.prescription = std::move(prescription);
  model.mask = held_mask(settings.crack_seeding, scene.cracks, model.grid);
  number_equations(model);
  seed_history(model, scene);
  return model;
}

}  // namespace fracfarm::phasefield::assembled
