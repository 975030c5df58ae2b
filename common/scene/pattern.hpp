// Random initial crack patterns (seed paper, eqs 18-22), drawn from Philox streams keyed by (campaign seed, sample id, role).
// A sample's pattern never depends on which others were drawn.
#pragma once

#include <cstdint>
#include <string_view>
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

// The cracks as drawn and clipped to the domain. id counts from 1.
std::vector<Segment> draw_pattern(CrackSet set, std::uint64_t campaign_seed, std::uint64_t id, const PatternSettings& settings = {});

// The part of a segment inside [0,width] x [0,height]; false where none is (zero length counts as none).
bool clip(Segment& segment, double width, double height);

// "uniaxial": 1 m/s outward on top and bottom, sides free; "biaxial": on all four. Empty result for other names.
struct NamedLoad {
  std::string_view name;
  bool horizontal;  // left and right move too
};
inline constexpr std::array<NamedLoad, 2> named_loads{{{"uniaxial", false}, {"biaxial", true}}};

// The scene of one sample of a dataset: pattern, material, load and defaults; what `fracfarm scene` prints.
Scene sample_scene(const Material& material, const NamedLoad& load, CrackSet set, std::uint64_t campaign_seed, std::uint64_t id,
                   const PatternSettings& settings = {});

}  // namespace fracfarm
