// The `material` of a scene: a name of the table, an object of properties, or layers from the bottom up.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/parse_parts.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_layers = 1000;
// No matter is lighter, softer or weaker; numbers near the smallest double would make steps that are not numbers.
constexpr Range stiffness{1.0, 1e15, "Pa"};

bool any(const Fields& fields, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (fields.has(key)) return true;
  return false;
}

// Either young and poisson, or the four constants; never both.
void read_elasticity(Fields& fields, Material& material) {
  const bool isotropic_given = any(fields, {"young", "poisson"});
  const bool constants_given = any(fields, {"C11", "C13", "C33", "C55"});
  if (isotropic_given && constants_given)
    fields.problems().add(fields.path("young"), "given with C11 C13 C33 C55", "either young and poisson, or the four constants",
                          "remove one of the two");
  else
    constants_given ? fields.require({"C11", "C13", "C33", "C55"}) : fields.require({"young", "poisson"});

  const bool isotropic_good = static_cast<int>(fields.number("young", stiffness, material.young)) +
                                  static_cast<int>(fields.number("poisson", {0.0, 0.4999, ""}, material.poisson)) ==
                              2;
  Elasticity& c = material.elasticity;
  int constants = 0;
  constants += fields.number("C11", stiffness, c.C11);
  constants += fields.number("C13", {-1e15, 1e15, "Pa"}, c.C13);
  constants += fields.number("C33", stiffness, c.C33);
  constants += fields.number("C55", stiffness, c.C55);
  if (isotropic_good) c = isotropic(*material.young, *material.poisson);
  if (constants == 4 && !(c.C11 * c.C33 > c.C13 * c.C13))
    fields.problems().add(fields.path("C13"), shortest(c.C13),
                          fmt::format("|C13| below sqrt(C11 C33) = {}", shortest(std::sqrt(c.C11 * c.C33))),
                          "the stiffness must be positive definite");
}

void read_plasticity(Fields& fields, Material& material) {
  Plasticity plasticity;
  const bool given = any(fields, {"yield", "hardening"});
  if (given) fields.require({"yield", "hardening"});
  fields.number("yield", stiffness, plasticity.yield);
  fields.number("hardening", {0.0, 1e15, "Pa"}, plasticity.hardening);
  if (!given) return;
  material.plasticity = plasticity;
  if (!material.young && fields.has("C11"))
    fields.problems().add(fields.path("yield"), "given with C11 C13 C33 C55", "isotropic materials only", "give young and poisson");
}

void read_cohesion(Fields& fields, Material& material) {
  Cohesion cohesion;
  const bool given = any(fields, {"friction", "tensile_strength", "shear_strength", "GI", "GII"});
  if (given) fields.require({"friction", "tensile_strength", "shear_strength", "GI", "GII"});
  fields.number("friction", {0.0, 10.0, ""}, cohesion.friction);
  fields.number("tensile_strength", stiffness, cohesion.tensile_strength);
  fields.number("shear_strength", stiffness, cohesion.shear_strength);
  fields.number("GI", {0.0, 1e12, "J/m^2", true}, cohesion.GI);
  fields.number("GII", {0.0, 1e12, "J/m^2", true}, cohesion.GII);
  if (given) material.cohesion = cohesion;
}

Material read_object(const json& value, const std::string& path, bool width_needed, ProblemList& problems) {
  Material material;
  material.name = "custom";
  Fields fields(value, path, problems);
  fields.require({"density", "Gc"});
  if (width_needed && !fields.has("characteristic_width"))
    problems.add(fields.path("characteristic_width"), "(missing)", "required key while phase_field.length_scale is 'half' or 'full'");
  fields.number("density", {1e-3, 1e6, "kg/m^3"}, material.density);
  fields.number("Gc", {1e-9, 1e12, "J/m^2"}, material.Gc);
  fields.number("characteristic_width", {1e-9, 1e3, "m"}, material.characteristic_width);
  read_elasticity(fields, material);
  read_plasticity(fields, material);
  read_cohesion(fields, material);
  fields.done();
  return material;
}

Material read_material(const json& value, const std::string& path, bool width_needed, ProblemList& problems) {
  if (!value.is_string()) return read_object(value, path, width_needed, problems);
  std::vector<std::string_view> names;
  for (const Material& row : material_table()) names.push_back(row.name);
  const auto index = read_word(value, path, names, {}, problems);
  return index ? material_table()[*index] : Material{};
}

std::vector<Layer> read_layer_list(const json& list, double height, bool width_needed, ProblemList& problems) {
  if (!list.is_array() || list.empty() || list.size() > max_layers) {
    problems.add("material.layers", printed(list), fmt::format("a list of 1 to {} layers from the bottom up", max_layers));
    return {};
  }
  std::vector<Layer> layers;
  double floor = 0.0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool last = i + 1 == list.size();
    Layer layer{.below = height, .material = {}};
    Fields fields(list[i], key_path("material.layers", i), problems);
    fields.require({"material"});
    if (!last) fields.require({"below"});
    // The last layer reaches the top; saying so is allowed, anything else is a gap.
    fields.number("below", last ? Range{height, height, "m"} : Range{floor, height, "m", true, true}, layer.below);
    if (const json* material = fields.value("material"))
      layer.material = read_material(*material, fields.path("material"), width_needed, problems);
    fields.done();
    floor = layer.below;
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace

std::vector<Layer> read_layers(const json& value, double height, bool width_needed, ProblemList& problems) {
  if (value.is_object() && value.contains("layers")) {
    Fields fields(value, "material", problems);
    std::vector<Layer> layers = read_layer_list(*fields.value("layers"), height, width_needed, problems);
    fields.done();
    return layers;
  }
  return {Layer{.below = height, .material = read_material(value, "material", width_needed, problems)}};
}

json material_properties(const Material& material) {
  json out{{"density", material.density}, {"Gc", material.Gc}};
  if (material.young && material.poisson) {
    out["young"] = *material.young;
    out["poisson"] = *material.poisson;
  } else {
    const Elasticity& c = material.elasticity;
    out.update({{"C11", c.C11}, {"C13", c.C13}, {"C33", c.C33}, {"C55", c.C55}});
  }
  if (material.characteristic_width > 0) out["characteristic_width"] = material.characteristic_width;
  if (material.plasticity) out.update({{"yield", material.plasticity->yield}, {"hardening", material.plasticity->hardening}});
  if (const auto& joint = material.cohesion)
    out.update({{"friction", joint->friction},
                {"tensile_strength", joint->tensile_strength},
                {"shear_strength", joint->shear_strength},
                {"GI", joint->GI},
                {"GII", joint->GII}});
  return out;
}

json material_json(const Material& material) { return find_material(material.name) ? json(material.name) : material_properties(material); }

}  // namespace fracfarm
