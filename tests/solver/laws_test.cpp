#include <catch2/catch.hpp>

#include <cmath>

#include "solver/law/degradation.hpp"
#include "solver/law/secant.hpp"
#include "solver/law/splits.hpp"
#include "solver/law/surface.hpp"

using namespace fracfarm;
using Strain = law::Strain<double>;
using Stress = law::Stress<double>;
using Stiffness = law::Stiffness<double>;
using law::degradation;
using law::reduced_stiffness;
using law::reduction;
using law::secant;
using law::stored_energy;
using law::strain_energy;
using law::stress;

namespace {

const Stiffness shale{3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9};
const law::Secant<double> steel = secant(2e11 / (3 * (1 - 2 * 0.3)), 2e11 / (2 * 1.3), 6e8, 2.5e9);

constexpr double lambda = 2.0e9, mu = 1.5e9;
const Stiffness isotropic{lambda + 2 * mu, lambda, lambda + 2 * mu, mu};
const law::StarConvexSplit<double> star_convex{lambda + 2 * mu / 3, mu, 1.0 / 3.0, 3.0};
const Strain strains[] = {{1e-3, 5e-4, 2e-4},  {1e-3, -4e-4, 7e-4}, {-1e-3, -2e-3, 1e-3}, {-1e-3, 3e-4, -5e-4},
                          {1e-3, 1e-3, 1e-10}, {-2e-3, 1e-3, 0.0},  {-1e-3, -1e-3, 3e-3}};

template <class Energy>
Stress slope(Energy energy, const Strain& e) {
  const double d = 1e-8;
  return {(energy(Strain{e.xx + d, e.zz, e.xz}) - energy(Strain{e.xx - d, e.zz, e.xz})) / (2 * d),
          (energy(Strain{e.xx, e.zz + d, e.xz}) - energy(Strain{e.xx, e.zz - d, e.xz})) / (2 * d),
          (energy(Strain{e.xx, e.zz, e.xz + d}) - energy(Strain{e.xx, e.zz, e.xz - d})) / (2 * d)};
}

void check_equal(const Stress& a, const Stress& b) {
  const double size = 2e6;  // Pa, of these strains
  CHECK(std::abs(a.xx - b.xx) < 1e-5 * size);
  CHECK(std::abs(a.zz - b.zz) < 1e-5 * size);
  CHECK(std::abs(a.xz - b.xz) < 1e-5 * size);
}

// Both stresses are derivatives of their energies, which together are the whole strain energy.
template <class Split>
void check_split(const Split& split) {
  for (const Strain& e : strains) {
    check_equal(split.degraded_stress(e), slope([&](const Strain& x) { return split.degraded_energy(x); }, e));
    check_equal(split.kept_stress(e), slope([&](const Strain& x) { return split.kept_energy(x); }, e));
    CHECK(split.degraded_energy(e) + split.kept_energy(e) == Approx(strain_energy(isotropic, e)).epsilon(1e-12));
  }
}

template <class Split>
bool turns_with_the_frame(const Split& split) {
  bool same = true;
  for (const Strain& e : strains)
    for (const double angle : {0.3, 0.9, 1.4}) {
      const double c = std::cos(angle), s = std::sin(angle);
      const Strain turned{c * c * e.xx + s * s * e.zz + s * c * e.xz, s * s * e.xx + c * c * e.zz - s * c * e.xz,
                          2 * s * c * (e.zz - e.xx) + (c * c - s * s) * e.xz};
      same = same && std::abs(split.drive(turned) - split.drive(e)) < 1e-9 * strain_energy(isotropic, e);
    }
  return same;
}

}  // namespace

TEST_CASE("stress is the derivative of the strain energy") {
  const Strain e{1e-3, -4e-4, 7e-4};
  const Stress s = stress(shale, e);
  const double d = 1e-6;
  const auto slope = [&](const Strain& by) {
    const Strain up{e.xx + by.xx, e.zz + by.zz, e.xz + by.xz}, down{e.xx - by.xx, e.zz - by.zz, e.xz - by.xz};
    return (strain_energy(shale, up) - strain_energy(shale, down)) / (2 * d);
  };
  CHECK(s.xx == Approx(slope({d, 0, 0})).epsilon(1e-9));
  CHECK(s.zz == Approx(slope({0, d, 0})).epsilon(1e-9));
  CHECK(s.xz == Approx(slope({0, 0, d})).epsilon(1e-9));
}

TEST_CASE("the seed's drive drops compression and keeps shear of either sign") {
  const law::SeedSplit<double> seed{shale};
  CHECK(seed.drive({1e-3, 2e-3, 1e-3}) == strain_energy(shale, {1e-3, 2e-3, 1e-3}));
  CHECK(seed.drive({-1e-3, 2e-3, 0.0}) == strain_energy(shale, {0.0, 2e-3, 0.0}));
  CHECK(seed.drive({-1e-3, -2e-3, -1e-3}) == strain_energy(shale, {0.0, 0.0, 1e-3}));
}

TEST_CASE("a split's stresses are the derivatives of its energies, which make up the whole") {
  check_split(law::SeedSplit<double>{isotropic});
  check_split(law::NoSplit<double>{isotropic});
  check_split(law::SpectralSplit<double>{lambda, mu});
  check_split(star_convex);
  check_split(law::StarConvexSplit<double>{lambda + 2 * mu / 3, mu, 1.0 / 3.0, 0.0});
}

TEST_CASE("all splits but the seed's give the same drive in every frame") {
  CHECK(turns_with_the_frame(law::NoSplit<double>{isotropic}));
  CHECK(turns_with_the_frame(law::SpectralSplit<double>{lambda, mu}));
  CHECK(turns_with_the_frame(star_convex));
  CHECK_FALSE(turns_with_the_frame(law::SeedSplit<double>{isotropic}));
}

TEST_CASE("star-convex with gamma* = -1 is no split, and its drive falls with gamma* where the body is compressed") {
  const law::StarConvexSplit<double> none{lambda + 2 * mu / 3, mu, 1.0 / 3.0, -1.0}, amor{lambda + 2 * mu / 3, mu, 1.0 / 3.0, 0.0};
  for (const Strain& e : strains) CHECK(none.drive(e) == Approx(strain_energy(isotropic, e)).epsilon(1e-12));
  const Strain compressed{-1e-3, -2e-3, 1e-3};
  CHECK(star_convex.drive(compressed) < amor.drive(compressed));
  CHECK(amor.drive(compressed) < none.drive(compressed));
}

TEST_CASE("spectral keeps all of an all-round compression and degrades all of an extension") {
  const law::SpectralSplit<double> spectral{lambda, mu};
  CHECK(spectral.degraded_energy({-1e-3, -2e-3, 0.0}) == 0.0);
  CHECK(spectral.kept_energy({1e-3, 2e-3, 0.0}) == 0.0);
}

TEST_CASE("plane stress carries a bar with Young's modulus") {
  const double young = mu * (3 * lambda + 2 * mu) / (lambda + mu), poisson = lambda / (2 * (lambda + mu));
  const Stress pulled = stress(law::plane_stress(isotropic), Strain{-poisson * 1e-3, 1e-3, 0.0});
  CHECK(std::abs(pulled.xx) < 1e-6);
  CHECK(pulled.zz == Approx(young * 1e-3).epsilon(1e-12));
}

TEST_CASE("AT1 stays at zero up to its elastic limit and AT2 does not") {
  const law::SurfaceLaw<double> one = law::at1(100.0, 1e-3), two = law::at2(100.0, 1e-3);
  const auto homogeneous = [](const law::SurfaceLaw<double>& f, double H) { return (2 * H - f.threshold) / (f.mass + 2 * H); };
  CHECK(homogeneous(one, one.floor) == 0.0);
  CHECK(homogeneous(one, 2 * one.floor) == Approx(0.5));
  CHECK(homogeneous(two, one.floor) > 0.2);
}

TEST_CASE("degradation is whole at 0, the residue at 1") {
  CHECK(degradation(0.0, 1e-6) == Approx(1.0).epsilon(1e-15));
  CHECK(degradation(1.0, 1e-6) == 1e-6);
  CHECK(degradation(0.5, 0.0) == 0.25);
}

TEST_CASE("before yield the secant law is elastic to the last bit, past it the equivalent stress is the hardening line") {
  CHECK(reduction(steel, 0.999 * steel.yield) == 1.0);
  for (const double factor : {1.5, 4.0, 20.0}) {
    const double q = factor * steel.yield, plastic = (q - steel.yield) / (3 * steel.mu + 2.5e9);
    CHECK(reduction(steel, q) * q == Approx(steel.yield + 2.5e9 * plastic).epsilon(1e-14));
  }
}

TEST_CASE("the secant stress is the derivative of its stored energy, before and past yield") {
  for (const double size : {1e-3, 1e-2}) {
    const Strain e{size, -0.3 * size, 0.5 * size};
    const auto energy = [](const Strain& x) { return stored_energy(steel, x, std::sqrt(von_mises_squared(steel, x))); };
    const double s = reduction(steel, std::sqrt(von_mises_squared(steel, e))), d = 1e-5 * size;
    const Stress found = stress(reduced_stiffness(steel, s), e);
    CHECK(found.xx == Approx((energy({e.xx + d, e.zz, e.xz}) - energy({e.xx - d, e.zz, e.xz})) / (2 * d)).epsilon(1e-7));
    CHECK(found.zz == Approx((energy({e.xx, e.zz + d, e.xz}) - energy({e.xx, e.zz - d, e.xz})) / (2 * d)).epsilon(1e-7));
    CHECK(found.xz == Approx((energy({e.xx, e.zz, e.xz + d}) - energy({e.xx, e.zz, e.xz - d})) / (2 * d)).epsilon(1e-7));
  }
}
