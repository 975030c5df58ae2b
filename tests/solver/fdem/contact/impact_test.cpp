// Restitution and friction between rigid bodies: what contact alone does to energy.
#include <catch2/catch.hpp>

#include "tests/solver/fdem/contact/random_pair.hpp"

using namespace fracfarm;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double time_step = 3e-8;  // s; the error of e goes with its square

}  // namespace

TEST_CASE("Without friction, kinetic energy comes back whatever the shapes, turns and offsets, and is never gained") {
  int met = 0;
  for (std::uint64_t id = 0; id < 100; ++id) {
    RandomStream random(7, id, 1);
    const Impact result = impact(random_pair(random), 0.0, time_step);
    if (!result.met) continue;
    ++met;
    INFO("impact " << id << " before " << result.before << " after " << result.after << " jumped " << result.jumped);
    const double e = std::sqrt(result.after / result.before);
    CHECK(std::abs(e - 1.0) < 0.005);
    CHECK(result.jumped == 0.0);
  }
  CHECK(met > 80);
}

TEST_CASE("With friction, kinetic energy lost is what friction booked") {
  int lost = 0;
  for (std::uint64_t id = 0; id < 60; ++id) {
    RandomStream random(7, id, 2);
    const Impact result = impact(random_pair(random), 0.6, time_step);
    if (!result.met) continue;
    INFO("impact " << id << " before " << result.before << " after " << result.after << " friction " << result.friction);
    CHECK(result.after + result.friction == Approx(result.before).epsilon(0.01));
    CHECK(result.friction >= 0.0);
    CHECK(result.after <= 1.01 * result.before);
    lost += result.after < 0.9 * result.before;
  }
  CHECK(lost > 10);
}
