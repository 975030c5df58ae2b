// The loads of a scene's sides.
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

std::vector<SideLoad> top_of(json load) { return scene_of(with("/loads/top", std::move(load))).on(Side::top); }
json part(double from, double to) { return {{"normal_velocity", 1.0}, {"from", from}, {"to", to}}; }

}  // namespace

TEST_CASE("fixed holds both directions of the whole side") {
  CHECK(top_of("fixed") ==
        std::vector<SideLoad>{{.from = 0, .to = 0.25, .normal_velocity = 0.0, .tangential = Tangential::fixed, .traction = {}}});
}

TEST_CASE("a side's object says normal, tangential, ramp and where") {
  const json load{{"normal_velocity", -2.0}, {"tangential_velocity", 0.5}, {"ramp", 1e-4}, {"from", 0.05}, {"to", 0.1}};
  const SideLoad expected{.from = 0.05,
                          .to = 0.1,
                          .normal_velocity = -2.0,
                          .tangential = Tangential::velocity,
                          .tangential_velocity = 0.5,
                          .ramp = 1e-4,
                          .traction = {}};
  CHECK(top_of(load) == std::vector<SideLoad>{expected});
  CHECK(top_of({{"normal_velocity", 1.0}, {"tangential", "fixed"}}).at(0).tangential == Tangential::fixed);
  CHECK(top_of({{"traction", {0, 1e6}}}).at(0).traction == std::array{0.0, 1e6});
}

TEST_CASE("pressure pushes inward on every side, and goes with neither traction nor motion") {
  CHECK(top_of({{"pressure", 2e6}}).at(0).traction == std::array{0.0, -2e6});
  CHECK(scene_of(with("/loads/left", {{"pressure", 2e6}})).on(Side::left).at(0).traction == std::array{2e6, 0.0});
  CHECK(scene_of(with("/loads/right", {{"pressure", 2e6}})).on(Side::right).at(0).traction == std::array{-2e6, 0.0});
  CHECK(scene_of(with("/loads/bottom", {{"pressure", -2e6}})).on(Side::bottom).at(0).traction == std::array{0.0, -2e6});
  problem_at(with("/loads/top", {{"pressure", 1.0}, {"traction", {0, 1}}}), "loads.top.pressure");
  problem_at(with("/loads/top", {{"pressure", 1.0}, {"normal_velocity", 1.0}}), "loads.top.pressure");
}

TEST_CASE("left and right are as long as the domain is high") {
  CHECK(scene_of(with("/loads/left", "fixed")).on(Side::left).at(0).to == 0.2);
  problem_at(with("/loads/left", part(0, 0.25)), "loads.left.to");
}

TEST_CASE("parts are sorted along the side, whatever their order in the file") {
  CHECK(top_of({part(0.1, 0.2), part(0.0, 0.1)}) == top_of({part(0.0, 0.1), part(0.1, 0.2)}));
}

TEST_CASE("every spelling of a free side is one scene") {
  CHECK(top_of("free").empty());
  CHECK(top_of(json::array()).empty());
  CHECK(top_of({{"tangential", "free"}}).empty());
}

TEST_CASE("loads that contradict themselves are refused") {
  const auto key_of = [](json load) { return problems_of(with("/loads/top", std::move(load))).at(0).key; };
  CHECK(key_of({part(0.0, 0.1), part(0.05, 0.2)}) == "loads.top");
  CHECK(key_of(part(0.1, 0.05)) == "loads.top.to");
  CHECK(key_of({{"normal_velocity", 1}, {"traction", {0, 1}}}) == "loads.top.traction");
  CHECK(key_of({{"tangential", "fixed"}, {"traction", {0, 1}}}) == "loads.top.traction");
  CHECK(key_of({{"tangential", "free"}, {"tangential_velocity", 1}}) == "loads.top.tangential");
  CHECK(key_of({{"ramp", 1e-4}}) == "loads.top.normal_velocity");
  CHECK(key_of({{"traction", {1}}}) == "loads.top.traction");
  CHECK(key_of(7) == "loads.top");
}

TEST_CASE("a side or word that does not exist comes with the nearest one") {
  CHECK(problem_at(with("/loads/botom", "free"), "loads.botom").suggestion == "did you mean 'bottom'?");
  CHECK(problem_at(with("/loads/top", "fixd"), "loads.top").suggestion == "did you mean 'fixed'?");
  CHECK(problem_at(with("/loads/top/normal_velocty", 1), "loads.top.normal_velocty").suggestion == "did you mean 'normal_velocity'?");
}
