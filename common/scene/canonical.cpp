// The canonical text of a scene and the identity made from it. Every key is written, so a default that changes later changes no old scene.
#include <nlohmann/json.hpp>

#include "common/base/hash.hpp"
#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/parse_parts.hpp"
#include "common/scene/pattern.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

json layers_json(const Scene& scene) {
  if (scene.layers.size() == 1) return material_json(scene.layers[0].material);
  json list = json::array();
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    json layer{{"material", material_json(scene.layers[i].material)}};
    if (i + 1 < scene.layers.size()) layer["below"] = scene.layers[i].below;
    list.push_back(std::move(layer));
  }
  return {{"layers", std::move(list)}};
}

json cracks_json(const Scene& scene) {
  json rows = json::array();
  for (const Segment& crack : scene.cracks) rows.push_back({crack.x0, crack.z0, crack.x1, crack.z1});
  return rows;
}

json loads_json(const Scene& scene) {
  json sides = json::object();
  for (const auto& [name, side] : side_words) sides[std::string(name)] = side_json(scene.on(side), side_length(scene, side));
  return sides;
}

json scene_json(const Scene& scene) {
  json out{{"schema", scene_schema},
           {"method", name_of(scene.method)},
           {"domain", {{"width", scene.width}, {"height", scene.height}}},
           {"material", layers_json(scene)},
           {"cracks", cracks_json(scene)},
           {"loads", loads_json(scene)},
           {"initial", {{"strain", scene.initial.strain}, {"velocity_gradient", scene.initial.velocity_gradient}}},
           {"time", {{"horizon", scene.horizon}, {"frame_interval", scene.frame_interval}, {"stop", spelled(stop_words, scene.stop)}}}};
  out[std::string(name_of(scene.method))] = scene.method == Method::fdem ? fdem_json(scene) : phase_field_json(scene);
  if (const auto& sample = scene.sample)
    out["sample"] = {{"set", name_of(sample->set)}, {"seed", sample->seed}, {"id", sample->id}, {"load", sample->load}};
  return out;
}

}  // namespace

std::string canonical_text(const Scene& scene) {
  return compact_text(scene.method == Method::drill ? drill_json(scene) : scene_json(scene));
}

// A line break cannot stand in canonical text, so no two pairs give the same bytes.
std::string job_key(std::string_view canonical_scene, std::string_view build_id) {
  std::string bytes(canonical_scene);
  bytes += '\n';
  bytes += build_id;
  return sha256_hex(bytes);
}

std::string_view name_of(Method method) { return spelled(method_words, method); }
std::string_view name_of(CrackSet set) { return spelled(crack_set_words, set); }
std::string_view name_of(Side side) { return spelled(side_words, side); }

std::string material_name(const Scene& scene) {
  if (scene.layers.empty()) return std::string(no_material);
  return scene.layers.size() == 1 ? scene.layers[0].material.name : "layers";
}

}  // namespace fracfarm
