#include <catch2/catch.hpp>

#include <cmath>

#include "solver/law/degradation.hpp"
#include "solver/law/secant.hpp"
#include "solver/law/seed_split.hpp"

using namespace fracfarm::law;

namespace {

const Stiffness shale{3.125738e10, 3.399087e9, 2.248732e10, 6.486048e9};
const Secant steel = secant(2e11 / (3 * (1 - 2 * 0.3)), 2e11 / (2 * 1.3), 6e8, 2.5e9);

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

TEST_CASE("the seed's positive energy drops compression and keeps shear of either sign") {
  CHECK(positive_energy(shale, {1e-3, 2e-3, 1e-3}) == strain_energy(shale, {1e-3, 2e-3, 1e-3}));
  CHECK(positive_energy(shale, {-1e-3, 2e-3, 0.0}) == strain_energy(shale, {0.0, 2e-3, 0.0}));
  CHECK(positive_energy(shale, {-1e-3, -2e-3, -1e-3}) == strain_energy(shale, {0.0, 0.0, 1e-3}));
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
