// Tables of twists, one file a family: what each does to a sound scene. A twist need not leave the scene valid.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "tests/robustness/draw.hpp"

namespace fracfarm::robustness {

struct Twist {
  std::string_view name;
  void (*bend)(nlohmann::json& scene, Draw& draw);
};

std::span<const Twist> crack_twists();     // where cracks lie
std::span<const Twist> grid_twists();      // domain, cells, layers
std::span<const Twist> material_twists();  // constants and lengths
std::span<const Twist> load_twists();      // loads, initial fields, times
std::span<const Twist> option_twists();    // words of the phase_field block
std::span<const Twist> mesh_twists();      // FDEM: slivers, settings, layers, bodies
std::span<const Twist> value_twists();     // one value replaced by what should not stand there

struct TextTwist {
  std::string_view name;
  void (*bend)(std::string& text, Draw& draw);
};

std::span<const TextTwist> text_twists();  // bytes that are no JSON, or hardly

// Sizes of a scene that is still sound where a twist needs them, 0 where they were bent away.
double number_at(const nlohmann::json& scene, const char* pointer);
// Everything with a length or a time times `factor`: the same problem at another size.
void resize(nlohmann::json& scene, double factor);

}  // namespace fracfarm::robustness
