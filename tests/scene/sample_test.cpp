// Scenes of samples, and scene keys set over them.
#include "common/scene/pattern.hpp"
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

SampleChoice choice(std::string_view material = "pbx", std::string_view load = "uniaxial") {
  return {.material = find_material(material), .load = find_load(load), .set = CrackSet::orthogonal, .seed = 2026, .id = 3};
}

Scene with_settings(const SampleChoice& sample, const std::vector<Setting>& over) {
  const Parsed<Scene> scene = sample_scene_with(sample, {}, over);
  if (!scene)
    for (const Problem& p : scene.error()) UNSCOPED_INFO(p.key << " = " << p.value << "; allowed: " << p.limit);
  REQUIRE(scene);
  return *scene;
}

Problems mistakes(const std::vector<Setting>& over) {
  const Parsed<Scene> scene = sample_scene_with(choice(), {}, over);
  return scene ? Problems{} : scene.error();
}

}  // namespace

TEST_CASE("a sample's scene holds its pattern, its material and where it came from") {
  const Scene scene = sample_scene(choice());
  CHECK(scene.cracks == draw_pattern(CrackSet::orthogonal, 2026, 3));
  CHECK(scene.layers.at(0).material == *find_material("pbx"));
  CHECK(scene.sample == Sample{CrackSet::orthogonal, 2026, 3, "uniaxial"});
  CHECK(scene.width == 0.25);
}

TEST_CASE("uniaxial pulls top and bottom at 1 m/s and leaves the sides free, biaxial pulls all four") {
  const Scene uniaxial = sample_scene(choice("steel", "uniaxial")), biaxial = sample_scene(choice("steel", "biaxial"));
  const std::vector<SideLoad> pulled{{.from = 0, .to = 0.25, .normal_velocity = 1.0, .traction = {}}};
  CHECK(uniaxial.on(Side::top) == pulled);
  CHECK(uniaxial.on(Side::bottom) == pulled);
  CHECK(uniaxial.on(Side::left).empty());
  for (const Side side : all_sides) CHECK(biaxial.on(side) == pulled);
}

TEST_CASE("every sample of every material and load reads back from its canonical text") {
  for (const Material& material : material_table())
    for (const NamedLoad& load : named_loads)
      for (std::uint64_t id = 1; id <= 20; ++id)
        for (const CrackSet set : {CrackSet::orthogonal, CrackSet::oblique}) {
          const Scene scene = sample_scene({&material, &load, set, UINT64_MAX, id});
          CHECK(parse_scene(canonical_text(scene)).value() == scene);
        }
}

TEST_CASE("no settings leave the sample as it is") { CHECK(with_settings(choice(), {}) == sample_scene(choice())); }

TEST_CASE("any scene key can be set over a sample") {
  Scene expected = sample_scene(choice());
  expected.phase_field.cells_x = 64;
  expected.phase_field.cells_z = 65;
  expected.phase_field.length_scale.kind = LengthScale::Kind::full;
  expected.stop = Stop::horizon;
  expected.loads[static_cast<std::size_t>(Side::top)].at(0).ramp = 1e-4;
  CHECK(with_settings(choice(), {{"phase_field.cells", "[64,65]"},
                                 {"phase_field.length_scale", "\"full\""},
                                 {"time.stop", "\"horizon\""},
                                 {"loads.top.ramp", "1e-4"}}) == expected);
}

TEST_CASE("a property set below material keeps the others and the horizon of the row") {
  const Scene scene = with_settings(choice("steel"), {{"material.Gc", "1000"}});
  Material expected = *find_material("steel");
  expected.name = "custom";
  expected.Gc = 1000;
  expected.default_horizon = Material{}.default_horizon;
  CHECK(scene.layers.at(0).material == expected);
  CHECK(scene.horizon == 2500e-6);
  CHECK(scene.phase_field.plasticity == PlasticityModel::secant);
}

TEST_CASE("the step can be set in seconds although the default is a fraction") {
  CHECK(with_settings(choice(), {{"phase_field.dt", "1e-7"}}).phase_field.dt == 1e-7);
}

TEST_CASE("the pattern fills the domain that was set") {
  const Scene scene = with_settings(choice(), {{"domain.width", "0.5"}});
  CHECK(scene.cracks == draw_pattern(CrackSet::orthogonal, 2026, 3, {.width = 0.5}));
  CHECK(scene.on(Side::top).at(0).to == 0.5);
  CHECK(problem_at(mistakes({{"domain.width", "0.03"}}), "domain.width").limit.find("buffers") != std::string::npos);
}

TEST_CASE("mistakes in settings are found all at once and name the setting") {
  const Problems problems = mistakes({{"phase_field.clf", "0.9"},
                                      {"time.horizon", "-1"},
                                      {"sample.id", "3"},
                                      {"loads.left.ramp", "1"},
                                      {"material.Gc", "{"},
                                      {"domain.width", "-1"}});
  CHECK(problem_at(problems, "phase_field.clf").suggestion == "did you mean 'cfl'?");
  for (const char* key : {"time.horizon", "sample.id", "loads.left.ramp", "material.Gc", "domain.width"}) problem_at(problems, key);
}

TEST_CASE("setting strange keys is answered, never crashed on") {
  for (const char* key :
       {"", ".", "..", "a.b.c", "domain", "domain.", ".domain", "cracks.0", "material.layers.0", "loads", "phase_field.cells.0"})
    for (const char* value : {"1", "null", "[]", "{}", "\"x\"", "nonsense", "{\"width\": 1e-9}"}) {
      const Problems problems = mistakes({{key, value}});
      CHECK((!problems.empty() || std::string_view(value) == "{}"));
    }
}
