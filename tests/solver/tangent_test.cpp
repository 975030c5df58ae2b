// Tangents of the implicit schemes against differences of the stresses, and J2's return against the closed forms of monotonic loading.
#include "solver/law/tangent.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "common/material/material.hpp"
#include "solver/phasefield/assembled/point_law.hpp"

using namespace fracfarm;
using namespace fracfarm::phasefield::assembled;

namespace {

constexpr double g = 0.3;
const Strain strains[] = {{1e-3, 5e-4, 2e-4},  {1e-3, -4e-4, 7e-4},  {-1e-3, -2e-3, 1e-3}, {-1e-3, 3e-4, -5e-4},
                          {-2e-3, 1e-3, 3e-5}, {-1e-3, -1e-3, 3e-3}, {2e-2, -1e-2, 3e-2},  {-1e-2, -2e-2, -1e-2}};

std::array<double, 3> stress_at(const PointLaw& law, const Strain& e, const Plastic& old) {
  return std::visit(
      [&](const auto& l) -> std::array<double, 3> {
        const Response r = l.answer(e, l.grow(e, old));
        return {g * r.degraded.xx + r.kept.xx, g * r.degraded.zz + r.kept.zz, g * r.degraded.xz + r.kept.xz};
      },
      law);
}

// Largest difference between the tangent and central differences of the stress, over the largest entry.
double worst_slope(const PointLaw& law, const Strain& e, const Plastic& old) {
  const Tangent t = std::visit([&](const auto& l) { return l.tangent(e, old, g); }, law);
  const double columns[3][3] = {{t.xx_xx, t.xx_zz, t.xx_xz}, {t.xx_zz, t.zz_zz, t.zz_xz}, {t.xx_xz, t.zz_xz, t.xz_xz}};
  double worst = 0.0, largest = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double d = 1e-9;
    Strain up = e, down = e;
    (c == 0 ? up.xx : c == 1 ? up.zz : up.xz) += d;
    (c == 0 ? down.xx : c == 1 ? down.zz : down.xz) -= d;
    const auto high = stress_at(law, up, old), low = stress_at(law, down, old);
    for (std::size_t r = 0; r < 3; ++r) {
      worst = std::max(worst, std::abs(columns[c][r] - (high[r] - low[r]) / (2.0 * d)));
      largest = std::max(largest, std::abs(columns[c][r]));
    }
  }
  return worst / largest;
}

PointLaw law_of(std::string_view material, Split split, PlasticityModel plasticity, Plane plane = Plane::strain) {
  PhaseFieldSettings settings;
  settings.split = split, settings.plasticity = plasticity, settings.plane = plane;
  return make_law(*find_material(material), settings);
}

}  // namespace

TEST_CASE("the tangent of every elastic split is the slope of its stress, in plane strain and plane stress") {
  for (const Split split : {Split::seed, Split::none, Split::spectral, Split::volumetric_deviatoric, Split::star_convex})
    for (const Plane plane : {Plane::strain, Plane::stress})
      for (const Strain& e : strains) {
        INFO(static_cast<int>(split) << " " << e.xx << " " << e.zz << " " << e.xz);
        CHECK(worst_slope(law_of("pbx", split, PlasticityModel::none, plane), e, {}) < 1e-6);
      }
}

TEST_CASE("the spectral tangent has a value where the principal strains are equal") {
  for (const double e : {1e-3, -1e-3}) CHECK(worst_slope(law_of("pbx", Split::spectral, PlasticityModel::none), {e, e, 0.0}, {}) < 1e-6);
}

TEST_CASE("the tangents of secant and J2 plasticity are the slopes of their stresses, before and past yield") {
  const Plastic worked{2e-3, -1e-3, 1e-3, 3e-3};
  for (const Strain& e : strains) {
    for (const Split split : {Split::seed, Split::none}) CHECK(worst_slope(law_of("steel", split, PlasticityModel::secant), e, {}) < 1e-6);
    for (const Split split : {Split::seed, Split::none, Split::volumetric_deviatoric, Split::star_convex})
      for (const Plastic& old : {Plastic{}, worked}) CHECK(worst_slope(law_of("steel", split, PlasticityModel::j2), e, old) < 1e-6);
  }
}

TEST_CASE("J2 returns to the yield line, keeps the volume, and is elastic when it unloads") {
  const law::J2<double> steel{1.6e11, 7.7e10, 6e8, 2.5e9};
  Plastic plastic{};
  for (int n = 1; n <= 40; ++n) {
    const Strain e{2e-4 * n, -1e-4 * n, 3e-4 * n};
    plastic = law::radial_return(steel, e, plastic);
    const double q = law::von_mises(steel, law::elastic_part(e, plastic));
    CHECK(q <= (steel.yield + steel.hardening * plastic.alpha) * (1 + 1e-12));
    if (plastic.alpha > 0.0) CHECK(q == Approx(steel.yield + steel.hardening * plastic.alpha).epsilon(1e-12));
  }
  REQUIRE(plastic.alpha > 1e-3);
  const Plastic after = law::radial_return(steel, {7.6e-3, -3.8e-3, 11.4e-3}, plastic);
  CHECK(after.alpha == plastic.alpha);
  CHECK(after.xx == plastic.xx);
}

TEST_CASE("under proportional loading J2 and the secant law give the same stress, and only J2 remembers") {
  const PointLaw j2 = law_of("steel", Split::none, PlasticityModel::j2), secant = law_of("steel", Split::none, PlasticityModel::secant);
  for (const double size : {1e-3, 1e-2, 5e-2}) {
    const Strain e{0.3 * size, -0.6 * size, 0.8 * size};
    const auto a = stress_at(j2, e, {}), b = stress_at(secant, e, {});
    for (std::size_t k = 0; k < 3; ++k) CHECK(a[k] == Approx(b[k]).epsilon(1e-12));
  }
  const Plastic worked = std::get<PlasticLaw>(j2).grow({0.0, 0.0, 5e-2}, {});
  CHECK(std::abs(stress_at(j2, {}, worked)[2]) > 1e8);
  CHECK(stress_at(secant, {}, {})[2] == 0.0);
}

TEST_CASE("the stored energy of a J2 point falls short of the work by the plastic work") {
  const PointLaw law = law_of("steel", Split::volumetric_deviatoric, PlasticityModel::j2);
  const PlasticLaw& j2 = std::get<PlasticLaw>(law);
  Plastic plastic{};
  double work = 0.0;
  Response last = j2.answer({}, plastic);
  constexpr int steps = 20000;
  const Strain step{4e-2 / steps, -1e-2 / steps, 3e-2 / steps};
  for (int n = 1; n <= steps; ++n) {
    const Strain e{n * step.xx, n * step.zz, n * step.xz};
    plastic = j2.grow(e, plastic);
    const Response now = j2.answer(e, plastic);
    work += 0.5 * ((last.degraded.xx + now.degraded.xx) * step.xx + (last.degraded.zz + now.degraded.zz) * step.zz +
                   (last.degraded.xz + now.degraded.xz) * step.xz);
    last = now;
  }
  CHECK(law::plastic_work(j2.j2, plastic) > 0.2 * work);
  CHECK(last.degraded_energy + law::plastic_work(j2.j2, plastic) == Approx(work).epsilon(1e-6));
}

TEST_CASE("a share of the plastic work adds to the drive of a J2 point") {
  PhaseFieldSettings settings;
  settings.plasticity = PlasticityModel::j2;
  const Material& steel = *find_material("steel");
  const auto drive = [&](double share) {
    settings.plastic_drive = share;
    const PlasticLaw law = std::get<PlasticLaw>(make_law(steel, settings));
    const Plastic plastic = law.grow({0.0, 0.0, 5e-2}, {});
    return std::pair{law.answer({0.0, 0.0, 5e-2}, plastic).drive, law::plastic_work(law.j2, plastic)};
  };
  CHECK(drive(0.5).first - drive(0.0).first == Approx(0.5 * drive(0.0).second).epsilon(1e-12));
}
