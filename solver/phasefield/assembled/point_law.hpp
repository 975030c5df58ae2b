// What a quadrature point answers to a strain, whatever the split and the plasticity: one type of law for each combination, all with the
// same three functions, so that loops are written once and dispatch once a row of elements: `grow` the plastic strain from that of the last
// step, `answer` to a strain at a plastic strain, and the `tangent` of the stress that the two give together.
#pragma once

#include <variant>

#include "common/scene/scene.hpp"
#include "solver/law/j2.hpp"
#include "solver/phasefield/assembled/element.hpp"

namespace fracfarm::phasefield::assembled {

using Stress = law::Stress<double>;
using Tangent = law::Tangent<double>;
using Plastic = law::Plastic<double>;
using ElasticStrain = law::ElasticStrain<double>;

struct Response {
  Stress degraded, kept;  // sigma = g degraded + kept, Pa
  double degraded_yy;     // out of plane, Pa; only where a plastic strain has an out-of-plane part
  ElasticStrain elastic;
  Plastic plastic;
  double drive, degraded_energy, kept_energy;  // J/m^3, undegraded
};

template <class Split>
struct ElasticLaw {
  Split split;
  static constexpr bool quadratic = true;  // the energies are; their stresses give the released energy to the last term
  static constexpr bool yields = false;

  Plastic grow(const Strain&, const Plastic&) const { return {}; }
  Response answer(const Strain& e, const Plastic&) const {
    return {split.degraded_stress(e), split.kept_stress(e), 0.0, {e.xx, e.zz, 0.0, e.xz}, {}, split.drive(e),
            split.degraded_energy(e), split.kept_energy(e)};
  }
  Tangent tangent(const Strain& e, const Plastic&, double g) const {
    return law::sum(g, law::degraded_tangent(split, e), 1.0, law::kept_tangent(split, e));
  }
};

// The secant law with a split that keeps nothing: the drive is that of the reduced moduli, the stored energy the potential of the stress.
template <template <class> class Split>
struct SecantLaw {
  law::Secant<double> secant;
  static constexpr bool quadratic = false;
  static constexpr bool yields = false;

  Plastic grow(const Strain&, const Plastic&) const { return {}; }
  Response answer(const Strain& e, const Plastic&) const {
    const double q = std::sqrt(law::von_mises_squared(secant, e));
    const law::Stiffness<double> reduced = law::reduced_stiffness(secant, law::reduction(secant, q));
    return {law::stress(reduced, e),
            {0.0, 0.0, 0.0},
            0.0,
            {e.xx, e.zz, 0.0, e.xz},
            {},
            Split<double>{reduced}.drive(e),
            law::stored_energy(secant, e, q),
            0.0};
  }
  Tangent tangent(const Strain& e, const Plastic&, double g) const {
    return law::sum(g, law::tangent(secant, e, std::sqrt(law::von_mises_squared(secant, e))), 0.0, Tangent{});
  }
};

// J2 with the star-convex split of the elastic energy (gamma = -1: none, 0: volumetric-deviatoric), or the seed's clipped drive without a
// split. `share` of the undegraded plastic work drives damage, too.
struct PlasticLaw {
  law::J2<double> j2;
  double gamma;
  bool clipped;
  double share;
  static constexpr bool quadratic = true;
  static constexpr bool yields = true;

  Plastic grow(const Strain& e, const Plastic& old) const { return law::radial_return(j2, e, old); }
  Response answer(const Strain& e, const Plastic& plastic) const;
  Tangent tangent(const Strain& e, const Plastic& old, double g) const;
};

using PointLaw = std::variant<ElasticLaw<law::SeedSplit<double>>, ElasticLaw<law::NoSplit<double>>, ElasticLaw<law::SpectralSplit<double>>,
                              ElasticLaw<law::StarConvexSplit<double>>, SecantLaw<law::SeedSplit>, SecantLaw<law::NoSplit>, PlasticLaw>;

PointLaw make_law(const Material& material, const PhaseFieldSettings& settings);

// True where the stress is proportional to the strain at fixed damage: one linear solve finds the displacements.
bool is_linear(const PointLaw& law);

}  // namespace fracfarm::phasefield::assembled
