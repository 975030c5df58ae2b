// Scene files in, scenes out. Every mistake is reported at once; unknown keys come with the nearest known one.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm {

inline constexpr std::string_view scene_schema = "fracfarm.scene/1";

// JSON text -> Scene with every default filled in and every limit checked. Never throws, whatever the bytes. Defaults that SCENES.md
// leaves open: frame_interval 5 us; a horizon of the material, of several the longest; sides without a load are free.
Parsed<Scene> parse_scene(std::string_view json_text);

// The canonical text: the whole scene as compact JSON, sorted keys, shortest round-trip numbers, defaults written out.
// parse_scene(canonical_text(s)) gives s back, and its canonical text is the same bytes. Materials of the table stand by name (the build id
// pins the table); `plasticity` is `none` wherever no layer yields, which is what `secant` means there.
std::string canonical_text(const Scene& scene);

// SHA-256 (hex) of the canonical text and the solver's build id: the identity of a job.
std::string job_key(std::string_view canonical_scene, std::string_view build_id);

std::string_view name_of(Method method);
std::string_view name_of(DrillAct act);
std::string_view name_of(CrackSet set);
std::string_view name_of(Side side);

// "pbx", "layers" where there is more than one, "none" where a drill has no body.
std::string material_name(const Scene& scene);

// Conditions that SCENES.md allows but a user should know of, one sentence each: w_0/h < 1, nu -> 1/2, cracks closer than 4 w_0, dt
// near the edge.
std::vector<std::string> scene_warnings(const Scene& scene);

}  // namespace fracfarm
