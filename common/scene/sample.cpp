// Scenes of a dataset's samples: pattern, material and load put together, with any scene key set over it.
#include <cassert>
#include <nlohmann/json.hpp>

#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/parse_parts.hpp"
#include "common/scene/pattern.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr double pull = 1.0;  // m/s outward (seed paper, phase-field runs; its signs would compress)

constexpr double plate_ramp = 1.0e-4;  // s, FDEM (seed paper: plates, "0 to 10^-4 s")

bool moves(const NamedLoad& load, Side side) { return load.horizontal || side == Side::bottom || side == Side::top; }

// FDEM's samples hang between rigid plates that they are tied to, so a pulled side keeps its length.
json pulled_side(Method method) {
  if (method == Method::fdem) return {{"normal_velocity", pull}, {"tangential", "fixed"}, {"ramp", plate_ramp}};
  return {{"normal_velocity", pull}};
}

// What a person would write: everything else is a default of the grammar, so that a default which hangs on a setting follows it.
json sample_json(const SampleChoice& choice, const PatternSettings& pattern) {
  json cracks = json::array();
  for (const Segment& crack : draw_pattern(choice.set, choice.seed, choice.id, pattern))
    cracks.push_back({crack.x0, crack.z0, crack.x1, crack.z1});
  json loads = json::object();
  for (const auto& [name, side] : side_words)
    loads[std::string(name)] = moves(*choice.load, side) ? pulled_side(choice.method) : json("free");
  return {{"schema", scene_schema},
          {"method", name_of(choice.method)},
          {"domain", {{"width", pattern.width}, {"height", pattern.height}}},
          {"material", material_json(*choice.material)},
          {"cracks", std::move(cracks)},
          {"loads", std::move(loads)},
          {"sample", {{"set", name_of(choice.set)}, {"seed", choice.seed}, {"id", choice.id}, {"load", choice.load->name}}}};
}

std::vector<std::string> split(std::string_view key) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= key.size();) {
    const std::size_t dot = std::min(key.find('.', start), key.size());
    words.emplace_back(key.substr(start, dot - start));
    start = dot + 1;
  }
  return words;
}

// A table row as its properties; the row's horizon is no property of an object, so it is written out.
void open_material(const Material& material, json& scene) {
  scene["material"] = material_properties(material);
  json& time = scene["time"];
  if (!time.contains("horizon")) time["horizon"] = material.default_horizon;
}

void set_key(const SampleChoice& choice, const Setting& setting, const json& value, json& scene, ProblemList& problems) {
  const std::vector<std::string> words = split(setting.first);
  json* place = &scene;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (i == 0 && words[0] == "material" && scene["material"].is_string()) open_material(*choice.material, scene);
    json& next = (*place)[words[i]];
    if (!next.is_null() && !next.is_object()) {
      problems.add(setting.first, printed(value), "a key below an object", "here it would be below " + printed(next));
      return;
    }
    place = &next;
  }
  (*place)[words.back()] = value;
}

bool settable(std::string_view key) {
  const std::string_view root = key.substr(0, key.find('.'));
  return root != "schema" && root != "method" && root != "sample" && key.size() <= 100 && !key.empty();
}

// The pattern fills the domain that the settings ask for.
void follow_domain(const Setting& setting, const json& value, PatternSettings& pattern) {
  if (!value.is_number()) return;
  if (setting.first == "domain.width") pattern.width = value.get<double>();
  if (setting.first == "domain.height") pattern.height = value.get<double>();
}

}  // namespace

Scene sample_scene(const SampleChoice& choice, const PatternSettings& settings) {
  assert(choice.material && choice.load && choice.id > 0);
  Parsed<Scene> scene = scene_from_json(sample_json(choice, settings));
  assert(scene && "a sample of the table is a scene");
  return std::move(*scene);
}

Parsed<Scene> sample_scene_with(const SampleChoice& choice, PatternSettings settings, std::span<const Setting> over) {
  assert(choice.material && choice.load && choice.id > 0);
  ProblemList problems;
  std::vector<std::pair<const Setting*, json>> values;
  for (const Setting& setting : over) {
    Parsed<json> value = read_json(setting.second, setting.first);
    if (!value)
      problems.add(setting.first, setting.second, "a JSON value");
    else if (!settable(setting.first))
      problems.add(setting.first, setting.second, "any scene key but schema, method and sample");
    else
      values.emplace_back(&setting, std::move(*value));
  }
  PatternSettings asked = settings;
  for (const auto& [setting, value] : values) follow_domain(*setting, value, asked);
  problems.add(check(asked));
  if (problems.empty()) settings = asked;  // else go on with a pattern that can be drawn, to find what else is wrong

  json scene = sample_json(choice, settings);
  for (const auto& [setting, value] : values) set_key(choice, *setting, value, scene, problems);
  Parsed<Scene> made = scene_from_json(scene);
  if (!made) problems.add(made.error());
  if (!problems.empty()) return tl::unexpected(problems.take());
  return made;
}

}  // namespace fracfarm
