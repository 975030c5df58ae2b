// One [[jobs]] block of a campaign file: materials, loads, patterns and the settings swept over. Not for other rooms.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/scene/fields.hpp"
#include "coordinator/campaign.hpp"

namespace fracfarm {

JobBlock read_block(const nlohmann::json& value, const std::string& path, ProblemList& problems);

}  // namespace fracfarm
