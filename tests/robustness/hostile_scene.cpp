#include "tests/robustness/hostile_scene.hpp"

#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

constexpr double cell = 0.25 / 127.0;  // m, as in the dataset

json pull(double velocity) { return {{"normal_velocity", velocity}}; }

json sound_cracks(Draw& draw, double width, double height) {
  json cracks = json::array();
  for (int k = draw.integer(0, 6); k > 0; --k) {
    const double x = draw.uniform(0.0, width), z = draw.uniform(0.0, height), length = draw.uniform(0.1, 0.5) * width;
    const bool across = draw.chance(0.6);
    cracks.push_back({x, z, across ? x + length : x, across ? z : z + length});
  }
  return cracks;
}

json sound_scene(Draw& draw) {
  static constexpr const char* materials[]{"pbx", "shale", "tungsten", "aluminum", "steel", "pbx5"};
  const int across = draw.integer(8, 48), up = draw.chance(0.5) ? across : draw.integer(8, 48);
  const double width = across * cell, height = up * cell, velocity = draw.log_uniform(0.5, 10.0);
  const double horizon = draw.uniform(5e-5, 3e-4);
  json scene{{"schema", "fracfarm.scene/1"},
             {"method", "phase_field"},
             {"domain", {{"width", width}, {"height", height}}},
             {"material", draw.pick(materials)},
             {"cracks", sound_cracks(draw, width, height)},
             {"loads", {{"top", pull(velocity)}, {"bottom", pull(velocity)}}},
             {"time", {{"horizon", horizon}, {"frame_interval", horizon / 4}}},
             {"phase_field", {{"cells", {across, up}}}}};
  if (draw.chance(0.4)) scene["loads"].update({{"left", pull(velocity)}, {"right", pull(velocity)}});
  return scene;
}

// A body of 10 to 30 elements across, on which a run takes a tenth of a second.
json sound_mesh_scene(Draw& draw) {
  static constexpr const char* materials[]{"pbx", "pbx5", "shale", "tungsten"};
  const double h = 0.003, width = draw.uniform(10.0, 30.0) * h, height = draw.chance(0.5) ? width : draw.uniform(10.0, 30.0) * h;
  const double velocity = draw.log_uniform(0.5, 20.0), horizon = draw.uniform(2e-5, 1.5e-4);
  const json plate{{"normal_velocity", velocity}, {"tangential", "fixed"}, {"ramp", draw.log_uniform(1e-6, 1e-4)}};
  json scene{{"schema", "fracfarm.scene/1"},
             {"method", "fdem"},
             {"domain", {{"width", width}, {"height", height}}},
             {"material", draw.pick(materials)},
             {"cracks", sound_cracks(draw, width, height)},
             {"loads", {{"top", plate}, {"bottom", plate}}},
             {"time", {{"horizon", horizon}, {"frame_interval", horizon / 4}}},
             {"fdem", {{"element_size", h}}}};
  if (draw.chance(0.3)) scene["loads"].update({{"left", plate}, {"right", plate}});
  return scene;
}

using Table = std::span<const Twist> (*)();

// Most scenes are bent within the grammar, so that they are solved; the rest is what a parser must refuse.
std::span<const Twist> family(Draw& draw) {
  static constexpr Table families[]{crack_twists,    crack_twists,    crack_twists,  crack_twists,  grid_twists,   grid_twists,
                                    grid_twists,     grid_twists,     load_twists,   load_twists,   load_twists,   load_twists,
                                    load_twists,     load_twists,     option_twists, option_twists, option_twists, material_twists,
                                    material_twists, material_twists, value_twists};
  return draw.pick(families)();
}
std::span<const Twist> mesh_family(Draw& draw) {
  static constexpr Table families[]{crack_twists, crack_twists, crack_twists, mesh_twists, mesh_twists, mesh_twists,
                                    mesh_twists,  mesh_twists,  load_twists,  load_twists, load_twists, value_twists};
  return draw.pick(families)();
}

}  // namespace

HostileScene hostile_scene(std::uint64_t seed, std::uint64_t index, Method method) {
  Draw draw(seed, index);
  const bool mesh = method == Method::fdem;
  json scene = mesh ? sound_mesh_scene(draw) : sound_scene(draw);
  HostileScene made;
  for (int k = draw.integer(1, 4); k > 0; --k) {
    const Twist& twist = draw.pick(mesh ? mesh_family(draw) : family(draw));
    try {
      twist.bend(scene, draw);
    } catch (const json::exception&) {
      continue;  // an earlier twist left nothing there to bend
    }
    made.twists += (made.twists.empty() ? "" : "+") + std::string(twist.name);
  }
  made.text = scene.dump(1, ' ', false, json::error_handler_t::replace);
  if (draw.chance(0.04)) {
    const TextTwist& twist = draw.pick(text_twists());
    twist.bend(made.text, draw);
    made.twists += "+" + std::string(twist.name);
  }
  return made;
}

double number_at(const json& scene, const char* pointer) {
  const json::json_pointer at(pointer);
  return scene.contains(at) && scene[at].is_number() ? scene[at].get<double>() : 0.0;
}

void resize(json& scene, double factor) {
  const auto scale = [&](const char* pointer) {
    const json::json_pointer at(pointer);
    if (scene.contains(at) && scene[at].is_number()) scene[at] = scene[at].get<double>() * factor;
  };
  for (const char* pointer : {"/domain/width", "/domain/height", "/time/horizon", "/time/frame_interval"}) scale(pointer);
  if (!scene["cracks"].is_array()) return;
  for (json& crack : scene["cracks"])
    for (json& end : crack)
      if (end.is_number()) end = end.get<double>() * factor;
}

}  // namespace fracfarm::robustness
