// What the tiers mean in numbers: penalties, and triangles that make up for softer joints.
#include "solver/fdem/materials.hpp"

#include "tests/solver/fdem/specimens.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

constexpr double h = 0.003, length_per_area = 3.5 / h;

// 1/Pa.
struct Compliance {
  double xx, zz, xz, shear;
};

// Of triangles and the joints between them.
Compliance compliance(const Material& material, const FdemSettings& settings) {
  const auto C = fdem::triangle_law(material, settings, length_per_area).stiffness;
  const double determinant = C.C11 * C.C33 - C.C13 * C.C13, s = 0.5 * length_per_area / fdem::penalty_of(material, settings);
  return {C.C33 / determinant + s, C.C11 / determinant + s, -C.C13 / determinant, 1.0 / C.C55 + 2.0 * s};
}

double factor_of(const Material& material, const FdemSettings& settings) {
  return fdem::penalty_of(material, settings) * settings.element_size / material.elasticity.C11;
}

}  // namespace

TEST_CASE("bodies of the fast tiers are as soft as those of the reference tier, whatever their joints") {
  for (const char* name : {"shale", "tungsten", "pbx5", "pbx"}) {
    INFO(name);
    const Material& material = *find_material(name);
    const Compliance wanted = compliance(material, settings_of(FdemTier::reference, h));
    CHECK(wanted.zz > 1.015 * compliance(material,
                                         [] {
                                           FdemSettings stiff = settings_of(FdemTier::reference, h);
                                           stiff.penalty = 1e6;
                                           return stiff;
                                         }())
                                  .zz);
    for (const std::optional<double> penalty : {std::optional<double>(), std::optional<double>(7.0)}) {
      FdemSettings settings = settings_of(FdemTier::fast, h);
      settings.penalty = penalty;
      const Compliance ours = compliance(material, settings);
      CHECK(ours.xx == Approx(wanted.xx).epsilon(1e-12));
      CHECK(ours.zz == Approx(wanted.zz).epsilon(1e-12));
      CHECK(ours.xz == Approx(wanted.xz).epsilon(1e-12));
      CHECK(ours.shear == Approx(wanted.shear).epsilon(1e-12));
    }
  }
}

TEST_CASE("the softer a tier's joints, the more viscosity its triangles have") {
  const Material& material = *find_material("pbx5");
  const auto viscosity = [&](FdemTier tier, double penalty) {
    FdemSettings settings = settings_of(tier, h);
    settings.penalty = penalty;
    return fdem::triangle_law(material, settings, length_per_area).viscosity;
  };
  const double reference = 0.1 * 2.0 * h * std::sqrt(fdem::young_of(material) * material.density);
  CHECK(viscosity(FdemTier::reference, 100.0) == reference);
  CHECK(viscosity(FdemTier::fast, 100.0 * fdem::young_of(material) / material.elasticity.C11) == Approx(reference).epsilon(1e-12));
  CHECK(viscosity(FdemTier::fast, 20.0) > 1.05 * reference);
  CHECK(viscosity(FdemTier::fast, 10.0) > 1.1 * viscosity(FdemTier::fast, 20.0));
}

TEST_CASE("joints of the fast tiers are stiffer where the cohesive zone is short, up to the reference tier's") {
  const FdemSettings settings = settings_of(FdemTier::fast, h);
  for (const char* name : {"shale", "pbx5", "pbx"}) CHECK(factor_of(*find_material(name), settings) == Approx(8.0).epsilon(1e-12));
  Material tungsten = *find_material("tungsten");
  CHECK(factor_of(tungsten, settings) > 15.0);
  const auto law = fdem::joint_law(tungsten, tungsten, settings);
  CHECK(law.per_rupture_n / law.per_onset_n == Approx(0.0075).epsilon(0.02));
  FdemSettings finer = settings;
  finer.element_size = 0.4 * h;
  CHECK(factor_of(tungsten, finer) == Approx(8.0).epsilon(1e-12));
  tungsten.cohesion->GI *= 1e-3;
  CHECK(fdem::penalty_of(tungsten, settings) == Approx(100.0 * fdem::young_of(tungsten) / h).epsilon(1e-12));
  FdemSettings told = settings;
  told.penalty = 10.0;
  CHECK(factor_of(tungsten, told) == Approx(10.0).epsilon(1e-12));
}
