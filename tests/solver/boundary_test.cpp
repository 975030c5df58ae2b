#include "solver/boundary.hpp"

#include <catch2/catch.hpp>

#include "solver/through_crack_watch.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

// Four nodes a side of a unit square, numbered 0...15 by row.
SideNodes four_by_four() {
  SideNodes nodes;
  for (std::size_t k = 0; k < 4; ++k) {
    const double at = static_cast<double>(k) / 3.0, from = k ? at - 1.0 / 6 : 0.0, to = k < 3 ? at + 1.0 / 6 : 1.0;
    nodes[0].push_back({4 * k, at, from, to});
    nodes[1].push_back({4 * k + 3, at, from, to});
    nodes[2].push_back({k, at, from, to});
    nodes[3].push_back({12 + k, at, from, to});
  }
  return nodes;
}

}  // namespace

TEST_CASE("extension points outward on every side") {
  Scene scene;
  for (Side side : all_sides) set_load(scene, side, pull(2.0, 1.0));
  const Boundary boundary = build_boundary(scene, four_by_four());
  REQUIRE(boundary.motions.size() == 4);
  const double signs[] = {-2.0, 2.0, -2.0, 2.0};
  for (std::size_t k = 0; k < 4; ++k) CHECK(boundary.motions[k].velocity == signs[k]);
}

TEST_CASE("a degree of freedom is told once: a normal velocity beats another side's tangential condition") {
  Scene scene;
  set_load(scene, Side::left, pull(1.0, 1.0));
  SideLoad fixed = pull(0.0, 1.0);
  fixed.tangential = Tangential::fixed;
  set_load(scene, Side::bottom, fixed);
  const Boundary boundary = build_boundary(scene, four_by_four());
  REQUIRE(boundary.motions.size() == 3);
  CHECK(boundary.motions[2].axis == Axis::x);
  CHECK(boundary.motions[2].nodes == std::vector<std::size_t>{1, 2, 3});  // 0 is the left side's
}

TEST_CASE("a part of a side holds the nodes on its ends, and shares its traction by stretch") {
  Scene scene;
  SideLoad part = pull(1.0, 2.0 / 3.0);
  part.from = 1.0 / 3.0;
  set_load(scene, Side::top, part);
  CHECK(build_boundary(scene, four_by_four()).motions[0].nodes == std::vector<std::size_t>{13, 14});
  part.normal_velocity.reset();
  part.traction = {0.0, 6.0};
  set_load(scene, Side::top, part);
  const Traction traction = build_boundary(scene, four_by_four()).tractions.at(0);
  REQUIRE(traction.nodes == std::vector<std::size_t>{13, 14});
  CHECK(traction.fz[0] == Approx(1.0));
  CHECK(traction.fz[0] + traction.fz[1] == Approx(2.0));
}

TEST_CASE("ramps grow from zero and stay, and no ramp is a step") {
  CHECK(ramp_share(0.0, 2.0) == 0.0);
  CHECK(ramp_share(0.5, 2.0) == 0.25);
  CHECK(ramp_share(9.0, 2.0) == 1.0);
  CHECK(ramp_share(0.0, 0.0) == 1.0);
}

TEST_CASE("cracks are watched across the loaded sides") {
  Scene scene;
  CHECK(watched_directions(scene).size() == 2);
  set_load(scene, Side::top, pull(1.0, 1.0));
  CHECK(watched_directions(scene) == std::vector<CrackDirection>{CrackDirection::left_right});
  set_load(scene, Side::bottom, pull(0.0, 1.0));
  set_load(scene, Side::left, pull(0.0, 1.0));
  CHECK(watched_directions(scene).size() == 1);  // held is not loaded
  set_load(scene, Side::right, pull(1.0, 1.0));
  CHECK(watched_directions(scene).size() == 2);
}
