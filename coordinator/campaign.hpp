// A campaign: which jobs there are (SCENES.md). TOML or JSON in, a numbered list of jobs out; scenes are made on demand, never stored.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/scene/pattern.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm {

struct IdRange {
  CrackSet set = CrackSet::orthogonal;
  std::uint64_t first = 1;
  std::uint64_t last = 1;
};

// One scene key of `set`, with one value or several (an axis of the sweep); values are JSON texts.
struct SettingAxis {
  std::string key;  // dotted, as phase_field.cfl
  std::vector<std::string> values;
};

struct JobBlock {
  Method method = Method::phase_field;
  std::vector<std::string> materials;
  std::vector<std::string> loads;
  std::vector<IdRange> patterns;  // orthogonal ones first, ids ascending, none twice
  std::vector<SettingAxis> set;   // by key
  bool redraw = false;            // cracks that leave the domain are drawn again, not clipped
};

struct Campaign {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<JobBlock> blocks;
  double wall_budget_s = 8.0 * 3600.0;
  int attempts = 3;
  std::string store = "store";  // relative paths are below the farm folder
};

// What one job is, before its scene is made. Pattern-major: all materials, loads and settings of a pattern come before the next pattern
// (settings change fastest, the last axis first).
struct JobSpec {
  std::size_t block = 0;
  Method method = Method::phase_field;
  std::string material;
  std::string load;
  CrackSet set = CrackSet::orthogonal;
  std::uint64_t sample_id = 0;
  std::vector<Setting> settings;  // one value of each axis
};

// Text of a campaign file, TOML or JSON (told apart by its first character). Reports every mistake with file:line where TOML knows it.
// Settings are checked by making the scene of every combination of values with each material and load of their block, once.
Parsed<Campaign> parse_campaign(std::string_view text, std::string_view file_name);

std::string canonical_text(const Campaign& campaign);  // compact JSON, sorted keys; parse_campaign of it gives the campaign back
std::uint64_t job_count(const Campaign& campaign);
JobSpec job_at(const Campaign& campaign, std::uint64_t index);             // index < job_count; the time does not depend on the index
Scene scene_of(const Campaign& campaign, const JobSpec& job);              // of a campaign that parse_campaign gave
Parsed<Scene> try_scene_of(const Campaign& campaign, const JobSpec& job);  // of one that is still being checked

}  // namespace fracfarm
