// One [[jobs]] block of a campaign file: materials, loads, patterns and the settings swept over. Not for other rooms.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "common/scene/fields.hpp"
#include "coordinator/campaign.hpp"

namespace fracfarm {

JobBlock read_block(const nlohmann::json& value, const std::string& path, ProblemList& problems);

// Whether a value in `set` is a list of values to sweep over; a few scene keys have lists as their one value.
bool is_axis(std::string_view key, const nlohmann::json& value);

}  // namespace fracfarm
