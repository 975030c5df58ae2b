// The material of a scene: names, objects, layers.
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

json glass() { return {{"density", 2450}, {"young", 32e9}, {"poisson", 0.2}, {"Gc", 3}, {"characteristic_width", 0.001}}; }

json glass_with(const char* key, json value) {
  json material = glass();
  material[key] = std::move(value);
  return with("/material", material);
}

json orthotropic() {
  return {{"density", 2000}, {"C11", 3e10}, {"C13", 3e9}, {"C33", 2e10}, {"C55", 6e9}, {"Gc", 50}, {"characteristic_width", 0.002}};
}

}  // namespace

TEST_CASE("a material object is read with its stiffness made from young and poisson") {
  const Material material = scene_of(with("/material", glass())).layers.at(0).material;
  CHECK(material.name == "custom");
  CHECK(material.elasticity == isotropic(32e9, 0.2));
  CHECK_FALSE(material.plasticity);
  CHECK_FALSE(material.cohesion);
}

TEST_CASE("the four constants are read as they are") {
  const Material material = scene_of(with("/material", orthotropic())).layers.at(0).material;
  CHECK(material.elasticity == Elasticity{3e10, 3e9, 2e10, 6e9});
  CHECK_FALSE(material.young);
}

TEST_CASE("a material without stiffness, toughness or density says what is missing") {
  for (const char* key : {"density", "Gc", "young", "poisson", "characteristic_width"}) {
    json material = glass();
    material.erase(key);
    CHECK(problem_at(with("/material", material), std::string("material.") + key).value == "(missing)");
  }
  json material = orthotropic();
  material.erase("C55");
  problem_at(with("/material", material), "material.C55");
}

TEST_CASE("the width may be left out where the length scale is in metres") {
  json material = glass();
  material.erase("characteristic_width");
  json scene = with("/material", material);
  scene["phase_field"]["length_scale"] = 0.003;
  CHECK(scene_of(scene).phase_field.length_scale == LengthScale{LengthScale::Kind::metres, 0.003});
}

TEST_CASE("impossible materials are refused") {
  problem_at(glass_with("density", 0), "material.density");
  problem_at(glass_with("poisson", 0.5), "material.poisson");
  problem_at(glass_with("poisson", -0.1), "material.poisson");
  problem_at(glass_with("young", -1), "material.young");
  problem_at(glass_with("C11", 1e10), "material.young");
  problem_at(glass_with("yield", 1e8), "material.hardening");
  problem_at(glass_with("friction", 0.6), "material.GII");
  json indefinite = orthotropic();
  indefinite["C13"] = 3e10;
  CHECK(problem_at(with("/material", indefinite), "material.C13").suggestion == "the stiffness must be positive definite");
  json yielding = orthotropic();
  yielding.update({{"yield", 1e8}, {"hardening", 1e8}});
  problem_at(with("/material", yielding), "material.yield");
}

TEST_CASE("secant is none where no layer yields, and stays where one does") {
  CHECK(scene_of(with("/phase_field/plasticity", "secant")) == scene_of(with("/phase_field/plasticity", "none")));
  json steel = with("/material", "steel");
  CHECK(scene_of(steel).phase_field.plasticity == PlasticityModel::secant);
  steel["phase_field"]["plasticity"] = "none";
  CHECK(scene_of(steel).phase_field.plasticity == PlasticityModel::none);
}

TEST_CASE("layers stand from the bottom up and the last reaches the top") {
  const json layers{{"layers", {{{"below", 0.07}, {"material", glass()}}, {{"below", 0.1}, {"material", "shale"}}, {{"material", "pbx"}}}}};
  const Scene scene = scene_of(with("/material", layers));
  REQUIRE(scene.layers.size() == 3);
  CHECK(scene.layers[0].below == 0.07);
  CHECK(scene.layers[1].material == *find_material("shale"));
  CHECK(scene.layers[2].below == 0.2);
  CHECK(material_name(scene) == "layers");
}

TEST_CASE("layers that sink, stick out or are not materials are refused") {
  const auto layers = [](json list) { return with("/material", {{"layers", std::move(list)}}); };
  const json top{{"material", "pbx"}};
  problem_at(layers({{{"below", 0.1}, {"material", "pbx"}}, {{"below", 0.05}, {"material", "pbx"}}, top}), "material.layers[1].below");
  problem_at(layers({{{"below", 0.2}, {"material", "pbx"}}, top}), "material.layers[0].below");
  problem_at(layers({{{"material", "pbx"}}, top}), "material.layers[0].below");
  problem_at(layers({{{"below", 0.1}, {"material", "pbx"}}}), "material.layers[0].below");
  problem_at(layers({{{"below", 0.1}, {"material", 7}}, top}), "material.layers[0].material");
  problem_at(layers(json::array()), "material.layers");
  problem_at(with("/material", {{"layers", {top}}, {"density", 1}}), "material.density");
  problem_at(with("/material", 7), "material");
}

TEST_CASE("one layer is the plain material") {
  CHECK(scene_of(with("/material", {{"layers", {{{"material", "shale"}}}}})) == scene_of(with("/material", "shale")));
}
