// The scene grammar: defaults, every block, and mistakes with key, value, limit and suggestion.
#include <cmath>
#include <filesystem>

#include "common/base/atomic_file.hpp"
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

TEST_CASE("a small scene gets every default of SCENES.md") {
  const Scene scene = scene_of(good_scene());
  PhaseFieldSettings defaults;  // of scene.hpp, but for the material: pbx does not yield
  defaults.plasticity = PlasticityModel::none;
  CHECK(scene.phase_field == defaults);
  CHECK(scene.phase_field.cells_x == 127);
  CHECK(scene.phase_field.residual_stiffness == 1e-6);
  CHECK(scene.phase_field.cfl == 0.9);
  CHECK(scene.horizon == 1000e-6);
  CHECK(scene.frame_interval == 5e-6);
  CHECK(scene.stop == Stop::failure);
  CHECK(scene.on(Side::left).empty());
  CHECK(scene.initial == Initial{});
  CHECK_FALSE(scene.sample);
}

TEST_CASE("SCENES.md's own example is a scene") {
  const Scene scene = scene_of(json::parse(R"({
    "schema": "fracfarm.scene/1", "method": "phase_field", "domain": {"width": 0.25, "height": 0.25}, "material": "pbx",
    "cracks": [[0.05, 0.10, 0.09, 0.10], [0.12, 0.06, 0.12, 0.10]],
    "loads": {"top": {"normal_velocity": 1.0}, "bottom": {"normal_velocity": 1.0}, "left": "free", "right": "free"},
    "time": {"horizon": 1.0e-3, "frame_interval": 5.0e-6, "stop": "failure"},
    "phase_field": {"cells": [127, 127], "length_scale": "half", "residual_stiffness": 1e-6, "crack_seeding": "slot", "integrator": "explicit",
                    "cfl": 0.9, "quadrature": "gll", "split": "seed", "plasticity": "secant", "precision": "double"},
    "fdem": {"element_size": 0.003, "tier": "fast", "softening": "munjiza", "mesh_seed": 1, "mesh_file": null}})"));
  CHECK(scene.cracks.size() == 2);
  CHECK(scene.on(Side::top).at(0).normal_velocity == 1.0);
}

TEST_CASE("the sample scenes are scenes") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FRACFARM_SOURCE_DIR "/deploy/scenes")) {
    INFO(entry.path());
    CHECK(parse_scene(read_file(entry.path(), 1'000'000).value()));
    ++count;
  }
  CHECK(count >= 3);
}

TEST_CASE("all mistakes of a scene are reported at once") {
  json scene = good_scene();
  scene["domain"]["width"] = -1;
  scene["material"] = "pbxx";
  scene["cracks"].push_back({1, 2, 3});
  scene["time"] = {{"stop", "never"}};
  scene["colour"] = "red";
  const Problems problems = problems_of(scene);
  CHECK(problems.size() == 5);
  for (const char* key : {"domain.width", "material", "cracks[1]", "time.stop", "colour"}) problem_at(problems, key);
}

TEST_CASE("a problem names the key, the value, the limit and the mend") {
  const Problem unknown = problem_at(with("/phase_field/clf", 0.5), "phase_field.clf");
  CHECK(unknown.value == "0.5");
  CHECK(unknown.limit.find("cells length_scale") != std::string::npos);
  CHECK(unknown.suggestion == "did you mean 'cfl'?");
  const Problem range = problem_at(with("/phase_field/cfl", 1.5), "phase_field.cfl");
  CHECK(range.limit == "a number above 0 to 1.2");
  CHECK(problem_at(with("/material", "stel"), "material").suggestion == "did you mean 'steel'?");
}

TEST_CASE("missing keys are named") {
  for (const char* key : {"method", "domain", "material"}) {
    json scene = good_scene();
    scene.erase(key);
    CHECK(problem_at(scene, key).value == "(missing)");
  }
  json scene = good_scene();
  scene["domain"].erase("height");
  problem_at(scene, "domain.height");
}

// One row for each number of the format: a value just allowed and one just not.
TEST_CASE("every number has its range") {
  struct Row {
    std::string pointer, key;
    json good, bad;
  };
  const std::vector<Row> rows{
      {"/domain/width", "domain.width", 1.0, 1001},
      {"/cracks/0/0", "cracks[0][0]", -1e4, 1.1e4},
      {"/time/horizon", "time.horizon", 1e-9, 0},
      {"/time/frame_interval", "time.frame_interval", 1e-6, -1e-6},
      {"/phase_field/residual_stiffness", "phase_field.residual_stiffness", 0.1, 0.11},
      {"/phase_field/cfl", "phase_field.cfl", 1.2, 1.21},
      {"/phase_field/dt", "phase_field.dt", 1e-8, 0},
      {"/loads/left/pressure", "loads.left.pressure", 1e13, 1.1e13},
      {"/phase_field/length_scale", "phase_field.length_scale", 1e-4, 0},
      {"/loads/top/normal_velocity", "loads.top.normal_velocity", -1e4, 1.1e4},
      {"/loads/top/ramp", "loads.top.ramp", 0, -1e-9},
      {"/loads/top/from", "loads.top.from", 0.1, -0.1},
      {"/loads/top/to", "loads.top.to", 0.25, 0.26},
      {"/initial/strain", "initial.strain[1]", {0, 0.1, 0}, {0, 0.11, 0}},
      {"/initial/velocity_gradient", "initial.velocity_gradient[3]", {0, 0, 0, 1e9}, {0, 0, 0, 1.1e9}},
  };
  for (const Row& row : rows) {
    INFO(row.key);
    CHECK(problems_of(with(row.pointer, row.good)).empty());
    problem_at(with(row.pointer, row.bad), row.key);
    problem_at(with(row.pointer, row.good.is_array() ? json("x") : json(true)),
               row.good.is_array() ? row.key.substr(0, row.key.find('[')) : row.key);
  }
}

TEST_CASE("cells are two positive integers") {
  CHECK(scene_of(with("/phase_field/cells", {64, 48})).phase_field.cells_z == 48);
  CHECK(scene_of(with("/phase_field/cells", {64.0, 48})).phase_field.cells_x == 64);
  problem_at(with("/phase_field/cells", {64, 48.5}), "phase_field.cells[1]");
  problem_at(with("/phase_field/cells", {0, 48}), "phase_field.cells[0]");
  problem_at(with("/phase_field/cells", {64}), "phase_field.cells");
  CHECK(problem_at(with("/phase_field/cells", {4000, 4000}), "phase_field.cells").limit == "at most 4000000 nodes");
  CHECK(problem_at(with("/phase_field/cells", {127, 5}), "phase_field.cells").suggestion == "squares need [127, 102]");
}

TEST_CASE("a block of the other method is let through only with that method's keys") {
  CHECK(scene_of(with("/fdem", {{"tier", "fast"}})) == scene_of(good_scene()));
  CHECK(problem_at(with("/fdem", {{"teir", "fast"}}), "fdem.teir").suggestion == "did you mean 'tier'?");
}

TEST_CASE("the step is given as cfl or as dt, not both, and never far past the edge") {
  json both = with("/phase_field/dt", 1e-7);
  both["phase_field"]["cfl"] = 0.9;
  problem_at(both, "phase_field.dt");
  // pbx: edge 586.8 ns at h = 0.25 m / 127; here the smaller cell is 0.2 m / 127, and 1.2 of its edge 563.3 ns.
  CHECK(problems_of(with("/phase_field/dt", 5.63e-7)).empty());
  problem_at(with("/phase_field/dt", 5.64e-7), "phase_field.dt");
}

TEST_CASE("the horizon follows the material, of layers the longest") {
  CHECK(scene_of(with("/material", "steel")).horizon == 2500e-6);
  const json layers = json::parse(R"({"layers": [{"below": 0.1, "material": "shale"}, {"material": "aluminum"}]})");
  CHECK(scene_of(with("/material", layers)).horizon == 1200e-6);
}

TEST_CASE("a run that could not be stored or would never end is refused") {
  problem_at(with("/time", {{"horizon", 1e-3}, {"frame_interval", 1e-9}}), "time.frame_interval");
  json endless = with("/time", {{"horizon", 1e3}, {"frame_interval", 1.0}});
  problem_at(endless, "time.horizon");
}

TEST_CASE("parts of cracks outside the domain are dropped") {
  json scene = good_scene();
  scene["cracks"] = {{0.2, 0.1, 0.3, 0.1}, {0.3, 0.3, 0.4, 0.4}, {-0.1, 0.05, 0.35, 0.05}};
  const Scene clipped = scene_of(scene);
  REQUIRE(clipped.cracks.size() == 2);
  CHECK(clipped.cracks[0] == Segment{0.2, 0.1, 0.25, 0.1});
  CHECK(clipped.cracks[1] == Segment{0, 0.05, 0.25, 0.05});
  problem_at(with("/cracks/0", {0.1, 0.1, 0.1, 0.1}), "cracks[0]");
}

TEST_CASE("sample keeps 64-bit seeds to the last digit") {
  const json sample{{"set", "oblique"}, {"seed", UINT64_MAX}, {"id", 9007199254740993ull}, {"load", "biaxial"}};
  const Scene scene = scene_of(with("/sample", sample));
  CHECK(scene.sample == Sample{CrackSet::oblique, UINT64_MAX, 9007199254740993ull, "biaxial"});
  problem_at(with("/sample", {{"set", "oblique"}, {"seed", -1}, {"id", 0}, {"load", "x"}}), "sample.seed");
  problem_at(with("/sample", {{"set", "oblique"}, {"seed", 1}, {"id", 0}, {"load", "x"}}), "sample.id");
}

TEST_CASE("a file without schema is of the first version, another version is refused") {
  json scene = good_scene();
  scene.erase("schema");
  CHECK(problems_of(scene).empty());
  CHECK(problem_at(with("/schema", "fracfarm.scene/2"), "schema").limit == "fracfarm.scene/1");
}

TEST_CASE("negative zero is zero") {
  CHECK_FALSE(std::signbit(scene_of(with("/cracks/0", {-0.0, 0.1, 0.1, 0.1})).cracks.at(0).x0));
  CHECK(canonical_text(scene_of(with("/cracks/0", {-0.0, 0.1, 0.1, 0.1}))) ==
        canonical_text(scene_of(with("/cracks/0", {0, 0.1, 0.1, 0.1}))));
}
