#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

constexpr const char* sides[]{"left", "right", "bottom", "top"};

// Tears any material of the table within a few steps.
void impact(json& scene, Draw& draw) {
  const double velocity = draw.log_uniform(15.0, 1e3);
  scene["loads"] = {{"top", {{"normal_velocity", velocity}}}, {"bottom", {{"normal_velocity", velocity}}}};
}
void absurd_velocity(json& scene, Draw& draw) {
  static constexpr double values[]{1e4, -1e4, 1.0001e4, 1e300, -1e300, 1e-300, 4.9e-324, -0.0, 1e-12};
  for (const char* side : sides)
    if (draw.chance(0.6)) scene["loads"][side] = {{"normal_velocity", draw.pick(values)}};
}
void compression(json& scene, Draw& draw) {
  const double velocity = -draw.log_uniform(0.1, 50.0);
  scene["loads"] = {{"top", {{"normal_velocity", velocity}}}, {"bottom", {{"normal_velocity", velocity}}}};
}
void ramped(json& scene, Draw& draw) {
  const double ramp = draw.log_uniform(1e-12, 1e3);
  for (const char* side : sides)
    if (scene["loads"].contains(side) && scene["loads"][side].is_object()) scene["loads"][side]["ramp"] = ramp;
}
void sheared(json& scene, Draw& draw) {
  const double velocity = draw.sign() * draw.log_uniform(0.1, 50.0);
  scene["loads"] = {{"top", {{"tangential_velocity", velocity}}}, {"bottom", "fixed"}};
  if (draw.chance(0.5)) scene["loads"]["top"]["normal_velocity"] = 0.0;
}
void pulled_by_traction(json& scene, Draw& draw) {
  const double size = draw.log_uniform(1.0, 1e9);
  scene["loads"] = {
      {"top", {{"traction", {draw.sign() * draw.log_uniform(1.0, size + 2.0), size}}, {"ramp", draw.log_uniform(1e-9, 1e-3)}}},
      {"bottom", draw.chance(0.5) ? json("fixed") : json{{"traction", {0.0, -size}}}}};
}
void absurd_traction(json& scene, Draw& draw) {
  static constexpr double values[]{1e13, -1e13, 1e14, 1e-300, 0.0, 4.9e-324};
  scene["loads"][draw.pick(sides)] = {{"traction", {draw.pick(values), draw.pick(values)}}};
}

// Parts of a side: touching, overlapping, thinner than the nodes' distance, beyond the end.
void in_parts(json& scene, Draw& draw) {
  const double width = number_at(scene, "/domain/width");
  json parts = json::array();
  double from = 0.0;
  for (int k = draw.integer(1, 5); k > 0; --k) {
    const double to = draw.chance(0.15) ? from + 1e-12 * width : from + draw.uniform(0.01, 0.4) * width;
    json part{{"from", from}, {"to", to}};
    if (draw.chance(0.5))
      part["normal_velocity"] = draw.uniform(-5.0, 5.0);
    else
      part["traction"] = {draw.uniform(-1e7, 1e7), draw.uniform(-1e7, 1e7)};
    if (draw.chance(0.05)) part["tangential"] = "fixed";
    parts.push_back(part);
    from = draw.chance(0.1) ? 0.5 * (from + to) : to + (draw.chance(0.5) ? 0.0 : 0.05 * width);
  }
  scene["loads"]["top"] = parts;
}
void all_fixed(json& scene, Draw& draw) {
  scene["loads"] = {{"left", "fixed"}, {"right", "fixed"}, {"top", "fixed"}, {"bottom", "fixed"}};
  if (draw.chance(0.5)) scene["loads"][draw.pick(sides)] = {{"normal_velocity", 5.0}};
}
void nothing_loads(json& scene, Draw&) { scene["loads"] = json::object(); }
void one_side(json& scene, Draw& draw) {
  scene["loads"] = {{draw.pick(sides), {{"normal_velocity", draw.sign() * draw.log_uniform(0.1, 30.0)}}}};
}
void contradiction(json& scene, Draw& draw) {
  const json wrong[]{{{"normal_velocity", 1.0}, {"traction", {0.0, 1e6}}},
                     {{"tangential", "fixed"}, {"tangential_velocity", 1.0}},
                     {{"ramp", 1e-5}},
                     json::object(),
                     {{"normal_velocity", 1.0}, {"from", 1.0}, {"to", 0.0}},
                     "gripped"};
  scene["loads"][draw.pick(sides)] = draw.pick(wrong);
}

void strained(json& scene, Draw& draw) {
  const double size = draw.log_uniform(1e-8, 0.1);
  scene["initial"]["strain"] = {draw.uniform(-1, 1) * size, draw.uniform(-1, 1) * size, draw.uniform(-1, 1) * size};
  if (draw.chance(0.5)) scene["loads"] = json::object();
}
void flying_apart(json& scene, Draw& draw) {
  const double size = draw.log_uniform(1e-3, 1e9);
  scene["initial"]["velocity_gradient"] = {draw.uniform(-1, 1) * size, draw.uniform(-1, 1) * size, draw.uniform(-1, 1) * size,
                                           draw.uniform(-1, 1) * size};
}
void spinning(json& scene, Draw& draw) {
  const double rate = draw.log_uniform(1e-3, 1e5);
  scene["loads"] = json::object();
  scene["initial"]["velocity_gradient"] = {0.0, -rate, rate, 0.0};
}

void short_horizon(json& scene, Draw& draw) { scene["time"]["horizon"] = draw.log_uniform(1e-30, 1e-7); }
void long_horizon(json& scene, Draw& draw) {
  const double horizon = draw.log_uniform(1e-3, 1e6);
  scene["time"] = {{"horizon", horizon}, {"frame_interval", horizon / draw.log_uniform(1.0, 1e5)}};
}
void odd_frames(json& scene, Draw& draw) {
  scene["time"]["frame_interval"] = number_at(scene, "/time/horizon") * draw.log_uniform(1e-5, 1e3);
}
void default_times(json& scene, Draw&) { scene.erase("time"); }
void to_the_horizon(json& scene, Draw&) { scene["time"]["stop"] = "horizon"; }

constexpr Twist table[]{
    {"impact", impact},
    {"absurd_velocity", absurd_velocity},
    {"compression", compression},
    {"ramped", ramped},
    {"sheared", sheared},
    {"pulled_by_traction", pulled_by_traction},
    {"absurd_traction", absurd_traction},
    {"in_parts", in_parts},
    {"all_fixed", all_fixed},
    {"nothing_loads", nothing_loads},
    {"one_side", one_side},
    {"contradiction", contradiction},
    {"strained", strained},
    {"flying_apart", flying_apart},
    {"spinning", spinning},
    {"short_horizon", short_horizon},
    {"long_horizon", long_horizon},
    {"odd_frames", odd_frames},
    {"default_times", default_times},
    {"to_the_horizon", to_the_horizon},
};

}  // namespace

std::span<const Twist> load_twists() { return table; }

}  // namespace fracfarm::robustness
