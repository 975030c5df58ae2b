// Scene number K of a seed: a small sound scene, bent by one to four twists from the tables of twists.hpp. Says nothing of what the scene
// should end as; that is outcome.hpp's.
#pragma once

#include <cstdint>
#include <string>

#include "common/scene/scene.hpp"

namespace fracfarm::robustness {

struct HostileScene {
  std::string text;    // what the parser is given; JSON or not
  std::string twists;  // names, joined by +
};

HostileScene hostile_scene(std::uint64_t seed, std::uint64_t index, Method method = Method::phase_field);

}  // namespace fracfarm::robustness
