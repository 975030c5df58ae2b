// The splits by name, in the order of tables and plots.
#pragma once

#include <array>
#include <string_view>

#include "common/scene/scene.hpp"

namespace fracfarm::verification {

struct NamedSplit {
  Split split;
  std::string_view name;
};
inline constexpr std::array<NamedSplit, 5> all_splits{{{Split::seed, "seed"},
                                                       {Split::none, "none"},
                                                       {Split::spectral, "spectral"},
                                                       {Split::volumetric_deviatoric, "vol-dev"},
                                                       {Split::star_convex, "star-convex"}}};

}  // namespace fracfarm::verification
