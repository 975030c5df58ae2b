// FD-15: tiny elements injected on purpose. Every choice is refused with a reason or meshed well; never a bad mesh, never for ever.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "common/base/random.hpp"
#include "tests/solver/fdem/mesh/mesh_checks.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double h = 0.003;

// A body of 20 x 20 elements: small, so that many fit in a second.
MeshChoice body(std::vector<Segment> cracks) { return {0.06, 0.06, h, 1, std::move(cracks), {}}; }

// From 1e-9 to 1 element.
std::vector<double> distances() {
  std::vector<double> list;
  for (double d = 1e-9; d < 1; d *= 1.7) list.push_back(d * h);
  for (int k = 1; k <= 20; ++k) list.push_back(0.05 * k * h);
  return list;
}

}  // namespace

TEST_CASE("cracks that nearly coincide are joined or parted at every distance") {
  for (const double d : distances()) {
    INFO("distance " << d / h << " elements");
    CHECK(verdict_on(body({{0.01, 0.03, 0.05, 0.03}, {0.02, 0.03 + d, 0.055, 0.03 + d}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.01, 0.05, 0.05}, {0.01 + d, 0.01, 0.05 + d, 0.05}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.03, 0.05, 0.03}, {0.01, 0.03, 0.05, 0.03 + d}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.03, 0.05, 0.03}, {0.01, 0.03 - d, 0.05, 0.03 + d}})) == "made");
  }
}

TEST_CASE("ends near cracks, ends and sides are put on them or left clear at every distance") {
  for (const double d : distances()) {
    INFO("distance " << d / h << " elements");
    CHECK(verdict_on(body({{0.01, 0.03, 0.05, 0.03}, {0.03, 0.03 + d, 0.03, 0.05}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.03, 0.05, 0.03}, {0.03, 0.03 - d, 0.03, 0.05}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.03, 0.03, 0.03}, {0.03 + d, 0.03, 0.05, 0.03}})) == "made");
    CHECK(verdict_on(body({{0.01, 0.03, 0.03, 0.03}, {0.03 + d, 0.03 + d, 0.03 + d, 0.05}})) == "made");
    CHECK(verdict_on(body({{d, 0.03, 0.05, 0.03}, {0.03, 0.03, 0.03, 0.06 - d}})) == "made");
    CHECK(verdict_on(body({{0.02, d, 0.05, 0.04}})) == "made");
  }
}

TEST_CASE("cracks along sides, into corners and across them are meshed") {
  for (const double d : distances()) {
    INFO("distance " << d / h << " elements");
    CHECK(verdict_on(body({{0.01, d, 0.05, d}, {0.06 - d, 0.01, 0.06 - d, 0.05}})) == "made");
    CHECK(verdict_on(body({{d, 0.0, 0.05, 0.06}, {0.0, 0.06 - d, 0.06, 0.0}})) == "made");
    CHECK(verdict_on(body({{0.0, 2 * h + d, 2 * h + d, 0.0}})) == "made");
  }
  CHECK(verdict_on(body({{0, 0, 0.06, 0}, {0, 0, 0, 0.06}, {0, 0, 0.06, 0.06}, {0, 0.06, 0.06, 0}})) == "made");
}

TEST_CASE("cracks that cross at tiny angles are led together") {
  for (double angle = 1e-9; angle < 1.6; angle *= 1.5) {
    const double dx = 0.022 * std::cos(angle), dz = 0.022 * std::sin(angle);
    INFO("angle " << angle);
    CHECK(verdict_on(body({{0.008, 0.03, 0.052, 0.03}, {0.03 - dx, 0.03 - dz, 0.03 + dx, 0.03 + dz}})) == "made");
    CHECK(verdict_on(body({{0.008, 0.03, 0.052, 0.03}, {0.01, 0.03, 0.01 + 2 * dx, 0.03 + dz}})) == "made");
  }
}

TEST_CASE("a crack given many times is one crack") {
  const std::vector<Segment> twenty(20, Segment{0.013, 0.021, 0.047, 0.039});
  const MeshResult many = make_mesh(body(twenty)), one = make_mesh(body({twenty.front()}));
  REQUIRE((many && one));
  CHECK(many->mesh == one->mesh);
  CHECK(many->report.moved == 19);
}

TEST_CASE("cracks shorter than half an element are refused by name, longer ones meshed") {
  for (const double share : {1e-9, 0.1, 0.3, 0.49}) {
    const MeshResult made = make_mesh(body({{0.01, 0.03, 0.05, 0.03}, {0.03, 0.02, 0.03 + share * h, 0.02}}));
    REQUIRE_FALSE(made);
    CHECK(made.error().starts_with("crack 1 is "));
  }
  for (const double share : {0.51, 0.7, 0.99, 1.2, 1.49})
    CHECK(verdict_on(body({{0.03, 0.02, 0.03 + share * h, 0.02}, {0.01, 0.04, 0.01 + 0.8 * share * h, 0.04 + 0.6 * share * h}})) == "made");
}

TEST_CASE("numbers that are none and sizes that cannot be are refused with a reason") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300}) {
    CHECK(verdict_on(body({{0.01, bad, 0.05, 0.03}})) == "refused");
    CHECK(verdict_on({bad, 0.06, h, 1, {}, {}}) == "refused");
    CHECK(verdict_on({0.06, 0.06, bad, 1, {}, {}}) == "refused");
    CHECK(verdict_on({0.06, 0.06, h, 1, {}, {bad}}) == "refused");
  }
  for (const double bad : {0.0, -1.0, 1e-300, 1e-6}) CHECK(verdict_on({0.06, 0.06, bad, 1, {}, {}}) == "refused");
  CHECK(verdict_on({0.06, 0.005, h, 1, {}, {}}) == "refused");
  CHECK(verdict_on({0.06, 0.06, h, 1, {}, {0.03, 0.0301}}) == "refused");
  CHECK(verdict_on({0.06, 0.06, h, 1, {}, {0.001}}) == "refused");
}

TEST_CASE("five hundred cracks on top of each other are meshed or refused") {
  RandomStream random(5, 1, 1);
  for (int round = 0; round < 2; ++round) {
    std::vector<Segment> cracks;
    for (int i = 0; i < 500; ++i) {
      const double x = random.uniform(0.0, 0.25), z = random.uniform(0.0, 0.25);
      cracks.push_back({x, z, x + random.uniform(-0.03, 0.03), z + (round == 0 ? 0.002 : random.uniform(-0.03, 0.03))});
    }
    const std::string verdict = verdict_on({0.25, 0.25, 0.005, 1, cracks, {}}, 1.5);
    CHECK((verdict == "made" || verdict == "refused"));
  }
}

TEST_CASE("a body that is cracked everywhere is meshed") {
  std::vector<Segment> cracks;
  for (int i = 1; i < 20; ++i) {
    cracks.push_back({0.0, i * h, 0.06, i * h});
    cracks.push_back({i * h, 0.0, i * h, 0.06});
  }
  CHECK(verdict_on(body(cracks)) == "made");
}

TEST_CASE("random tangles of short cracks give a good mesh or a reason") {
  RandomStream random(6, 1, 1);
  int made = 0;
  for (int round = 0; round < 150; ++round) {
    std::vector<Segment> cracks;
    for (int i = random.integer(1, 25); i > 0; --i) {
      const double x = random.uniform(-0.01, 0.07), z = random.uniform(-0.01, 0.07);
      cracks.push_back({x, z, x + random.uniform(-0.02, 0.02), z + random.uniform(-0.02, 0.02)});
    }
    MeshChoice choice = body(cracks);
    if (round % 3 == 0) choice.layers = {0.02, 0.041};
    INFO("round " << round);
    const std::string verdict = verdict_on(choice, 1.5);
    made += verdict == "made";
    CHECK((verdict == "made" || verdict == "refused"));
  }
  CHECK(made > 100);  // those refused have a crack shorter than half an element or a triangle that no free point can mend
}

}  // namespace fracfarm::fdem
