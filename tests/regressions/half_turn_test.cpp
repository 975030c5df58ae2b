// A triangle that had turned by half a turn got a strain of 0 / 0, and close to it one of rounding times the square of the rest.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/law/corotated.hpp"

namespace fracfarm {
namespace {

template <class Real>
double strain_of_a_turn(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0, c = degrees == 180.0 ? -1.0 : std::cos(angle),
               s = degrees == 180.0 ? 0.0 : std::sin(angle);
  const law::Gradient<Real> H{static_cast<Real>(c - 1.0), static_cast<Real>(-s), static_cast<Real>(s), static_cast<Real>(c - 1.0)};
  const law::Strain<Real> strain = law::biot(H, law::turn(H));
  const double worst = std::abs(double(strain.xx)) + std::abs(double(strain.zz)) + std::abs(double(strain.xz));
  return worst / std::numeric_limits<Real>::epsilon();
}

}  // namespace

TEST_CASE("a triangle that turned whole has no strain but rounding, half a turn included", "[fdem]") {
  for (const double degrees :
       {0.0, 1.0, 45.0, 89.999, 90.0, 90.001, 135.0, 170.0, 179.0, 179.9, 179.99999, 180.0, 180.00001, 181.0, 270.0, 359.0}) {
    INFO(degrees);
    CHECK(strain_of_a_turn<double>(degrees) < 10.0);
    CHECK(strain_of_a_turn<float>(degrees) < 10.0);
  }
}

}  // namespace fracfarm
