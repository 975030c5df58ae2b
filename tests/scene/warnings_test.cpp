// What a scene may do but a user should know of.
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

// The good scene with square cells of 2 mm, so that it warns of nothing.
json quiet() {
  json scene = good_scene();
  scene["phase_field"]["cells"] = {125, 100};
  return scene;
}

std::string warning(json scene) {
  const std::vector<std::string> all = scene_warnings(scene_of(scene));
  REQUIRE(all.size() == 1);
  return all[0];
}

}  // namespace

TEST_CASE("a well-posed scene warns of nothing") { CHECK(scene_warnings(scene_of(quiet())).empty()); }

TEST_CASE("an under-resolved length scale is told, once for each material") {
  json scene = quiet();
  scene["material"] =
      json::parse(R"({"layers": [{"below": 0.1, "material": "shale"}, {"below": 0.15, "material": "pbx"}, {"material": "shale"}]})");
  CHECK(warning(scene).find("shale: w_0 = 1 mm is 0.50 of a cell") == 0);
}

TEST_CASE("a length scale of very many cells is told") {
  json scene = quiet();
  scene["phase_field"]["length_scale"] = 0.1;
  CHECK(warning(scene).find("w_0 = 100 mm is 50 cells") != std::string::npos);
}

TEST_CASE("a nearly incompressible material is told") {
  json scene = quiet();
  scene["material"] = {{"density", 1000}, {"young", 1e9}, {"poisson", 0.48}, {"Gc", 10}, {"characteristic_width", 0.01}};
  CHECK(warning(scene).find("Poisson's ratio 0.48") != std::string::npos);
  CHECK(warning(scene).find("the edge of the step to 0.89") != std::string::npos);
}

TEST_CASE("cells that are not square are told") {
  json scene = quiet();
  scene["phase_field"]["cells"] = {125, 120};
  CHECK(warning(scene).find("not square") != std::string::npos);
}

TEST_CASE("a step near the edge is told, however it was given") {
  json scene = quiet();
  scene["phase_field"]["cfl"] = 1.0;
  CHECK(warning(scene).find("1.000 of the stability edge") != std::string::npos);
  scene["phase_field"].erase("cfl");
  scene["phase_field"]["dt"] = 5.8e-7;
  CHECK(warning(scene).find("of the stability edge") != std::string::npos);
}

TEST_CASE("an implicit run is told of what makes it inaccurate or unstable") {
  json scene = quiet();
  scene["phase_field"] = {{"cells", scene["phase_field"]["cells"]}, {"integrator", "newmark"}, {"cfl", 2.0}};
  CHECK(scene_warnings(scene_of(scene)).empty());
  scene["phase_field"]["staggered_passes"] = 1;
  CHECK(warning(scene).find("a single staggered pass") == 0);
  scene["phase_field"].erase("staggered_passes");
  scene["phase_field"]["cfl"] = 8.0;
  CHECK(warning(scene).find("smeared") != std::string::npos);
  scene["phase_field"]["cfl"] = 2.0;
  scene["phase_field"]["newmark_beta"] = 0.2;
  CHECK(warning(scene).find("stable only for short steps") != std::string::npos);
}

TEST_CASE("a row of nodes as a crack is told under corner quadrature only") {
  json scene = quiet();
  scene["cracks"] = {{0.05, 0.1, 0.09, 0.1}};
  scene["phase_field"]["crack_seeding"] = "nodes";
  CHECK(warning(scene).find("do not cut") != std::string::npos);
  scene["phase_field"]["quadrature"] = "gauss";
  CHECK(scene_warnings(scene_of(scene)).empty());
}

TEST_CASE("a scene that nothing loads is told") {
  json scene = quiet();
  scene["loads"] = {{"top", "fixed"}};
  CHECK(warning(scene).find("nothing loads the body") == 0);
  scene["initial"]["strain"] = {0, 1e-4, 0};
  CHECK(scene_warnings(scene_of(scene)).empty());
}

TEST_CASE("cracks that nearly meet are counted, those that meet are not") {
  json scene = quiet();
  scene["cracks"] = {{0.05, 0.1, 0.09, 0.1}, {0.07, 0.098, 0.07, 0.12}, {0.092, 0.1, 0.12, 0.1}};
  CHECK(warning(scene).find("1 pair of cracks closer than 4 w_0 = 8 mm") == 0);
}

TEST_CASE("a frame interval beyond the horizon is told") {
  json scene = quiet();
  scene["time"] = {{"horizon", 1e-5}, {"frame_interval", 1e-3}};
  CHECK(warning(scene).find("frame interval") != std::string::npos);
}
