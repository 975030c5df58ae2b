#include "solver/phasefield/domain.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::phasefield {

Grid make_grid(const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  return {settings.cells_x + 1, settings.cells_z + 1, scene.width / settings.cells_x, scene.height / settings.cells_z};
}

const Material& material_at(const Scene& scene, double z) {
  for (const Layer& layer : scene.layers)
    if (&layer == &scene.layers.back() || z < layer.below) return layer.material;
  return scene.layers.back().material;
}

law::Stiffness<double> stiffness_of(const Material& material, const PhaseFieldSettings& settings) {
  const Elasticity& C = material.elasticity;
  const law::Stiffness<double> given{C.C11, C.C13, C.C33, C.C55};
  return settings.plane == Plane::stress ? law::plane_stress(given) : given;
}

double length_scale(const Material& material, const PhaseFieldSettings& settings) {
  switch (settings.length_scale.kind) {
    case LengthScale::Kind::half:
      return 0.5 * material.characteristic_width;
    case LengthScale::Kind::full:
      return material.characteristic_width;
    case LengthScale::Kind::metres:
      break;
  }
  return settings.length_scale.metres;
}

law::SurfaceLaw<double> surface_law(const Material& material, const PhaseFieldSettings& settings) {
  const double width = length_scale(material, settings);
  return settings.surface == SurfaceModel::at1 ? law::at1(material.Gc, width) : law::at2(material.Gc, width);
}

double star_convexity(const PhaseFieldSettings& settings) { return settings.split == Split::star_convex ? settings.star_convexity : 0.0; }

double stable_dt(const law::Stiffness<double>& C, double density, const PhaseFieldSettings& settings, const Grid& grid) {
  const double hx = grid.hx, hz = grid.hz;
  const double x = C.C11 / (hx * hx) + C.C55 / (hz * hz);
  const double z = C.C33 / (hz * hz) + C.C55 / (hx * hx);
  const double bulk = C.C13 + 2.0 * C.C55 * (settings.plane == Plane::stress ? 1.0 / 2.0 : 1.0 / 3.0);
  const double closed = (1.0 + star_convexity(settings)) * bulk;
  return std::min(std::sqrt(density / std::max(x, z)), std::min(hx, hz) * std::sqrt(density / closed));
}

}  // namespace fracfarm::phasefield
