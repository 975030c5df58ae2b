// Durations as people type them: 90, 30s, 10m, 8h, 2d.
#pragma once

#include <optional>
#include <string_view>

namespace fracfarm {

// Seconds; nothing where the text is not a positive number with an optional unit.
std::optional<double> parse_duration(std::string_view text);

}  // namespace fracfarm
