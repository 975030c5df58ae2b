#include "solver/phasefield/assembled/point_law.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

PointLaw secant_law(const Material& material, const PhaseFieldSettings& settings) {
  const Elasticity& C = material.elasticity;
  const auto secant = law::secant(C.C13 + (2.0 / 3.0) * C.C55, C.C55, material.plasticity->yield, material.plasticity->hardening);
  if (settings.split == Split::none) return SecantLaw<law::NoSplit>{secant};
  return SecantLaw<law::SeedSplit>{secant};
}

PointLaw plastic_law(const Material& material, const PhaseFieldSettings& settings) {
  const Elasticity& C = material.elasticity;
  const law::J2<double> j2{C.C13 + (2.0 / 3.0) * C.C55, C.C55, material.plasticity->yield, material.plasticity->hardening};
  const double gamma = settings.split == Split::star_convex             ? settings.star_convexity
                       : settings.split == Split::volumetric_deviatoric ? 0.0
                                                                        : -1.0;
  return PlasticLaw{j2, gamma, settings.split == Split::seed, settings.plastic_drive};
}

}  // namespace

Response PlasticLaw::answer(const Strain& e, const Plastic& plastic) const {
  Response r{};
  r.plastic = plastic;
  r.elastic = law::elastic_part(e, r.plastic);
  const ElasticStrain dev = law::deviator(r.elastic);
  const double trace = e.xx + e.zz, opening = law::positive(trace), closing = law::negative(trace);
  const double pressure = j2.bulk * (opening - gamma * closing), kept = (1.0 + gamma) * j2.bulk * closing;
  r.degraded = {pressure + 2.0 * j2.mu * dev.xx, pressure + 2.0 * j2.mu * dev.zz, j2.mu * dev.xz};
  r.degraded_yy = pressure + 2.0 * j2.mu * dev.yy;
  r.kept = {kept, kept, 0.0};
  r.degraded_energy = j2.mu * law::square(dev) + 0.5 * j2.bulk * (opening * opening - gamma * closing * closing);
  r.kept_energy = (1.0 + gamma) * 0.5 * j2.bulk * closing * closing;
  r.drive = (clipped ? law::clipped_energy(j2, r.elastic) : law::positive(r.degraded_energy)) + share * law::plastic_work(j2, r.plastic);
  return r;
}

Tangent PlasticLaw::tangent(const Strain& e, const Plastic& old, double g) const {
  const double bulk = e.xx + e.zz > 0.0 ? j2.bulk : -gamma * j2.bulk, kept = e.xx + e.zz > 0.0 ? 0.0 : (1.0 + gamma) * j2.bulk;
  return law::sum(g, law::consistent_tangent(j2, e, old, bulk), 1.0, Tangent{kept, kept, 0.0, kept, 0.0, 0.0});
}

PointLaw make_law(const Material& material, const PhaseFieldSettings& settings) {
  if (material.plasticity && settings.plasticity == PlasticityModel::secant) return secant_law(material, settings);
  if (material.plasticity && settings.plasticity == PlasticityModel::j2) return plastic_law(material, settings);
  const Elasticity& given = material.elasticity;
  law::Stiffness<double> C{given.C11, given.C13, given.C33, given.C55};
  if (settings.plane == Plane::stress) C = law::plane_stress(C);
  const double per_dimensions = settings.plane == Plane::stress ? 0.5 : 1.0 / 3.0;
  const auto star_convex = [&](double gamma) {
    return ElasticLaw<law::StarConvexSplit<double>>{{C.C13 + 2.0 * C.C55 * per_dimensions, C.C55, per_dimensions, gamma}};
  };
  switch (settings.split) {
    case Split::none:
      return ElasticLaw<law::NoSplit<double>>{{C}};
    case Split::spectral:
      return ElasticLaw<law::SpectralSplit<double>>{{C.C13, C.C55}};
    case Split::volumetric_deviatoric:
      return star_convex(0.0);
    case Split::star_convex:
      return star_convex(settings.star_convexity);
    case Split::seed:
      break;
  }
  return ElasticLaw<law::SeedSplit<double>>{{C}};
}

bool is_linear(const PointLaw& law) {
  return std::holds_alternative<ElasticLaw<law::SeedSplit<double>>>(law) || std::holds_alternative<ElasticLaw<law::NoSplit<double>>>(law);
}

}  // namespace fracfarm::phasefield::assembled
