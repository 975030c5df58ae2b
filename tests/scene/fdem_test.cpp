// Scenes of FDEM: defaults that follow the tier, mistakes, canonical text, and the loads of a sample between plates.
#include "common/scene/pattern.hpp"
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

json fdem_scene(json settings = json::object()) {
  json scene = good_scene();
  scene["method"] = "fdem";
  scene["material"] = "shale";
  scene["fdem"] = std::move(settings);
  return scene;
}

const std::string digest(64, 'a');

}  // namespace

TEST_CASE("an FDEM scene has the fast tier, elements of 3 mm and its own horizon") {
  const Scene scene = scene_of(fdem_scene());
  CHECK(scene.method == Method::fdem);
  CHECK(scene.fdem == FdemSettings{});
  CHECK(scene.horizon == 2e-3);
  CHECK(scene.frame_interval == 1e-5);
  json pbx = fdem_scene();
  pbx["material"] = "pbx5";
  CHECK(scene_of(pbx).horizon == 4e-3);
}

TEST_CASE("a penalty that leaves the triangles no stiffness between the joints is refused where joints are compensated") {
  CHECK(problem_at(problems_of(fdem_scene({{"penalty", 2.0}})), "fdem.penalty").limit.find("at least") != std::string::npos);
  CHECK(scene_of(fdem_scene({{"penalty", 4.0}})).fdem.penalty == 4.0);
  CHECK(scene_of(fdem_scene({{"tier", "reference"}, {"penalty", 2.0}})).fdem.penalty == 2.0);
  json stiff_upwards = fdem_scene();
  stiff_upwards["material"] = {{"density", 2500.0},
                               {"C11", 1e10},
                               {"C33", 6e10},
                               {"C13", 1e9},
                               {"C55", 4e9},
                               {"Gc", 20.0},
                               {"characteristic_width", 0.004},
                               {"friction", 0.5},
                               {"tensile_strength", 5e6},
                               {"shear_strength", 2e7},
                               {"GI", 30.0},
                               {"GII", 100.0}};
  problem_at(problems_of(stiff_upwards), "fdem.penalty");
}

TEST_CASE("the reference tier takes half the others' step, unless it is given") {
  CHECK(scene_of(fdem_scene({{"tier", "fast"}})).fdem.dt_fraction == 0.7);
  CHECK(scene_of(fdem_scene({{"tier", "reference"}})).fdem.dt_fraction == 0.35);
  CHECK(scene_of(fdem_scene({{"tier", "reference"}, {"dt_fraction", 0.7}})).fdem.dt_fraction == 0.7);
}

TEST_CASE("the screening tier has elements twice as long, unless they are given") {
  CHECK(scene_of(fdem_scene({{"tier", "screening"}})).fdem.element_size == 0.006);
  CHECK(scene_of(fdem_scene({{"tier", "screening"}, {"element_size", 0.004}})).fdem.element_size == 0.004);
}

TEST_CASE("every mistake of an fdem block is told at once") {
  const Problems problems = problems_of(
      fdem_scene({{"tier", "quick"}, {"penalty", 0.01}, {"mesh_file", "a.msh"}, {"dt", 1e-8}, {"dt_fraction", 0.5}, {"sede", 1}}));
  for (const char* key : {"fdem.tier", "fdem.penalty", "fdem.mesh_sha256", "fdem.dt", "fdem.sede"}) problem_at(problems, key);
  CHECK(problems.size() == 5);
  CHECK(problem_at(fdem_scene({{"mesh_sha256", digest}}), "fdem.mesh_sha256").suggestion == "remove the key");
}

TEST_CASE("an FDEM scene needs materials with joints, and elements that fit") {
  json metal = fdem_scene();
  metal["material"] = "steel";
  CHECK(problem_at(metal, "material").value == "steel");
  problem_at(fdem_scene({{"element_size", 0.06}}), "fdem.element_size");
  problem_at(fdem_scene({{"element_size", 1e-5}}), "fdem.element_size");
  problem_at(with("/time", {{"stop", "drop10"}}), "time.stop");
}

TEST_CASE("the canonical text of an FDEM scene gives the scene back and holds no other method's settings") {
  json file =
      fdem_scene({{"tier", "screening"}, {"penalty", 20.0}, {"precision", "double"}, {"mesh_file", "a.msh"}, {"mesh_sha256", digest}});
  file["time"] = {{"stop", "drop10"}};
  file["phase_field"] = {{"cfl", 0.5}};
  const Scene scene = scene_of(file);
  CHECK(*parse_scene(canonical_text(scene)) == scene);
  const json text = json::parse(canonical_text(scene));
  CHECK(text.contains("fdem"));
  CHECK_FALSE(text.contains("phase_field"));
  CHECK_FALSE(json::parse(canonical_text(scene_of(good_scene()))).contains("fdem"));
}

TEST_CASE("a sample of FDEM hangs between plates that keep its width and start slowly") {
  const Scene scene =
      sample_scene({.material = find_material("shale"), .load = find_load("uniaxial"), .seed = 2026, .id = 3, .method = Method::fdem});
  for (const Side side : {Side::top, Side::bottom}) {
    REQUIRE(scene.on(side).size() == 1);
    CHECK(scene.on(side)[0].normal_velocity == 1.0);
    CHECK(scene.on(side)[0].tangential == Tangential::fixed);
    CHECK(scene.on(side)[0].ramp == 1e-4);
  }
  CHECK(scene.on(Side::left).empty());
  const Scene grid = sample_scene({.material = find_material("shale"), .load = find_load("uniaxial"), .seed = 2026, .id = 3});
  CHECK(grid.cracks == scene.cracks);
}
