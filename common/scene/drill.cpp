// Scenes that simulate nothing: method "drill" rehearses what can go wrong on a farm (FARM.md). Such a scene has no body, no material and
// no loads; its one block says what its job does instead.
#include <nlohmann/json.hpp>

#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/parse_parts.hpp"
#include "common/scene/pattern.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr double longest_s = 86400.0;
constexpr std::uint64_t most_attempts = 1000;

void read_settings(Fields& top, DrillSettings& drill) {
  const json* value = top.value("drill");
  if (!value) return;
  Fields fields(*value, "drill", top.problems());
  fields.require({"act"});
  fields.word("act", drill_act_words, drill.act);
  fields.number("seconds", {0.0, longest_s, "s"}, drill.seconds);
  std::uint64_t attempts = 0;
  if (fields.integer("attempts", 0, most_attempts, attempts)) drill.attempts = static_cast<int>(attempts);
  fields.done();
}

// What tells the jobs of a campaign apart; the load is none.
void read_sample(Fields& top, Scene& scene) {
  const json* value = top.value("sample");
  if (!value) return;
  Sample sample;
  sample.load = no_load;
  Fields fields(*value, "sample", top.problems());
  fields.require({"set", "seed", "id", "load"});
  fields.word("set", crack_set_words, sample.set);
  fields.integer("seed", 0, UINT64_MAX, sample.seed);
  fields.integer("id", 1, UINT64_MAX, sample.id);
  fields.only("load", no_load);
  fields.done();
  scene.sample = sample;
}

}  // namespace

bool is_drill(const json& file) {
  return file.is_object() && file.contains("method") && file["method"].is_string() &&
         file["method"].get_ref<const std::string&>() == name_of(Method::drill);
}

Parsed<Scene> drill_from_json(const json& file) {
  ProblemList problems;
  Fields top(file, "", problems);
  top.require({"method", "drill"});
  top.allow({"method"});
  top.only("schema", scene_schema);
  DrillSettings drill;
  read_settings(top, drill);
  Scene scene = drill_scene(drill);
  read_sample(top, scene);
  top.done();
  if (!problems.empty()) return tl::unexpected(problems.take());
  return scene;
}

json drill_json(const Scene& scene) {
  json out{{"schema", scene_schema},
           {"method", name_of(Method::drill)},
           {"drill",
            {{"act", spelled(drill_act_words, scene.drill.act)}, {"seconds", scene.drill.seconds}, {"attempts", scene.drill.attempts}}}};
  if (const auto& sample = scene.sample)
    out["sample"] = {{"set", name_of(sample->set)}, {"seed", sample->seed}, {"id", sample->id}, {"load", sample->load}};
  return out;
}

// The smallest grid that a record can have, of unit size, at time 0.
Scene drill_scene(const DrillSettings& drill) {
  Scene scene;
  scene.method = Method::drill;
  scene.width = scene.height = 1.0;
  scene.phase_field.cells_x = scene.phase_field.cells_z = 1;
  scene.drill = drill;
  return scene;
}

Parsed<Scene> drill_sample(const SampleChoice& choice, std::span<const Setting> settings) {
  ProblemList problems;
  json scene{{"schema", scene_schema},
             {"method", name_of(Method::drill)},
             {"drill", {{"act", spelled(drill_act_words, DrillAct::sleep)}}},
             {"sample", {{"set", name_of(choice.set)}, {"seed", choice.seed}, {"id", choice.id}, {"load", no_load}}}};
  for (const auto& [key, text] : settings) {
    const Parsed<json> value = read_json(text, key);
    const bool of_drill = key.starts_with("drill.") && key.find('.', 6) == std::string::npos;
    if (!value || !of_drill)
      problems.add(key, text, of_drill ? "a JSON value" : "drill.act | drill.seconds | drill.attempts");
    else
      scene["drill"][key.substr(6)] = *value;
  }
  Parsed<Scene> made = scene_from_json(scene);
  if (!made) problems.add(made.error());
  if (!problems.empty()) return tl::unexpected(problems.take());
  return made;
}

std::string_view name_of(DrillAct act) { return spelled(drill_act_words, act); }

}  // namespace fracfarm
