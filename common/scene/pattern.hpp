// Random initial crack patterns (seed paper, eqs 18-22), drawn from Philox streams keyed by (campaign seed, sample id, role).
// A sample's pattern never depends on which others were drawn.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm {

struct PatternSettings {
  double width = 0.25;       // H_x, m
  double height = 0.25;      // H_z, m
  double buffer = 0.02;      // delta_x = delta_z: starts keep this distance from the sides, m
  double length_min = 0.01;  // m
  double length_max = 0.05;  // m
  int count_min = 3;         // of each of the two orthogonal sets; the oblique set draws 2 count_min ... 2 count_max
  int count_max = 15;
  bool redraw = false;  // draw a crack again while its end lies outside; otherwise the part outside is dropped
};

// Why no pattern can be drawn with these settings; empty where one can.
Problems check(const PatternSettings& settings);

// The cracks as drawn, clipped to the domain: horizontal ones first, then vertical ones, each set in the order of its draws. check() must
// be empty, ids count from 1.
std::vector<Segment> draw_pattern(CrackSet set, std::uint64_t campaign_seed, std::uint64_t id, const PatternSettings& settings = {});

// The part of a segment inside [0,width] x [0,height]; false where none is (zero length counts as none). Clipping twice changes no bit
// more.
bool clip(Segment& segment, double width, double height);

// "uniaxial": 1 m/s outward on top and bottom, sides free; "biaxial": on all four. Everywhere free along the side.
struct NamedLoad {
  std::string_view name;
  bool horizontal;  // left and right move too
};
inline constexpr std::array<NamedLoad, 2> named_loads{{{"uniaxial", false}, {"biaxial", true}}};
const NamedLoad* find_load(std::string_view name);  // nullptr where there is none

// Which sample of a dataset.
struct SampleChoice {
  const Material* material = nullptr;
  const NamedLoad* load = nullptr;
  CrackSet set = CrackSet::orthogonal;
  std::uint64_t seed = 0;  // of the campaign
  std::uint64_t id = 1;
  Method method = Method::phase_field;
};

// The scene of one sample: pattern, material, load and defaults; what `fracfarm scene` prints.
Scene sample_scene(const SampleChoice& choice, const PatternSettings& settings = {});

// A scene key (dotted, as phase_field.cfl) and its value as JSON text.
using Setting = std::pair<std::string, std::string>;

// The same with scene keys set over it, then read by the scene grammar: problems name the settings' keys. A key below `material` turns the
// table row into an object of its properties first; domain.width and domain.height are where the pattern is drawn, too. What names the
// sample (schema, method, sample) cannot be set.
Parsed<Scene> sample_scene_with(const SampleChoice& choice, PatternSettings settings, std::span<const Setting> over);

// What a drill has instead of a material and a load.
inline constexpr std::string_view no_material = "none", no_load = "none";
Scene drill_scene(const DrillSettings& drill);
// The drill of one sample of a campaign; settings are keys of its drill block. Set, seed and id of the choice tell jobs apart, nothing else.
Parsed<Scene> drill_sample(const SampleChoice& choice, std::span<const Setting> settings);

}  // namespace fracfarm
