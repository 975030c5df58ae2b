#include "solver/fdem/materials.hpp"

#include <algorithm>
#include <cmath>

#include "solver/law/compensated.hpp"

namespace fracfarm::fdem {
namespace {

struct Mode {
  double strength, toughness;
};

// The reference tier's, Pa/m: with joints of it alone a body is as soft as the fast tiers' are.
double reference_penalty(const Material& material, const FdemSettings& settings, double factor = 100.0) {
  return factor * young_of(material) / settings.element_size;
}

double softening_area(const FdemSettings& settings) {
  return curve_of(settings) == Curve::munjiza ? law::area_under<law::Munjiza>() : law::area_under<law::LinearSoftening>();
}

// The fast tiers', Pa/m. Soft joints weaken a body whose cohesive zone is a few elements short: they are as stiff as it takes for one to
// open by no more than a small share of its rupture opening before it softens.
double quick_penalty(const Material& material, const FdemSettings& settings) {
  constexpr double least = 8.0, most_onset = 0.0075;
  const double strength = material.cohesion->tensile_strength, rupture = material.cohesion->GI / (strength * softening_area(settings));
  const double stiff = std::max(least * material.elasticity.C11 / settings.element_size, strength / (most_onset * rupture));
  return std::min(stiff, reference_penalty(material, settings));
}

Mode weaker(Mode a, Mode b) { return {std::min(a.strength, b.strength), std::min(a.toughness, b.toughness)}; }

}  // namespace

double young_of(const Material& material) {
  const Elasticity& C = material.elasticity;
  return material.young ? *material.young : C.C33 - C.C13 * C.C13 / C.C11;
}

double penalty_of(const Material& material, const FdemSettings& settings) {
  if (settings.tier == FdemTier::reference) return reference_penalty(material, settings, settings.penalty.value_or(100.0));
  return settings.penalty ? *settings.penalty * material.elasticity.C11 / settings.element_size : quick_penalty(material, settings);
}

double contact_penalty_of(const Material& material, const FdemSettings& settings) { return settings.contact_penalty * young_of(material); }

Curve curve_of(const FdemSettings& settings) { return settings.softening == Softening::munjiza ? Curve::munjiza : Curve::linear; }

law::Joint<double> joint_law(const Material& left, const Material& right, const FdemSettings& settings) {
  const Cohesion &a = *left.cohesion, &b = *right.cohesion;
  const Mode tension = weaker({a.tensile_strength, a.GI}, {b.tensile_strength, b.GI});
  const Mode shear = weaker({a.shear_strength, a.GII}, {b.shear_strength, b.GII});
  const double p = std::min(penalty_of(left, settings), penalty_of(right, settings));
  const double area = softening_area(settings);
  return {p, p / tension.strength, p / shear.strength, 1.0 / law::rupture_opening(p, tension.strength, tension.toughness, area),
          1.0 / law::rupture_opening(p, shear.strength, shear.toughness, area)};
}

TriangleLaw<double> triangle_law(const Material& material, const FdemSettings& settings, double length_per_area) {
  const Elasticity& e = material.elasticity;
  const law::Stiffness<double> bulk{e.C11, e.C13, e.C33, e.C55};
  law::Stiffness<double> C = bulk;
  double damping = settings.viscosity * 2.0 * settings.element_size * std::sqrt(young_of(material) * material.density);
  if (settings.tier != FdemTier::reference) {
    const double softer = 1.0 / penalty_of(material, settings) - 1.0 / reference_penalty(material, settings);
    C = law::compensated(bulk, 0.5 * length_per_area * softer);
    damping *= law::damping_ratio(bulk, C);
  }
  TriangleLaw<double> law{};
  law.stiffness = C;
  law.viscosity = damping;
  law.per_mass = 3.0 / material.density;
  law.plastic = material.plasticity.has_value();
  if (law.plastic) law.j2 = {C.C13 + 2.0 / 3.0 * C.C55, C.C55, material.plasticity->yield, material.plasticity->hardening};
  return law;
}

}  // namespace fracfarm::fdem
