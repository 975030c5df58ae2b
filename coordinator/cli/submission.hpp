// Submitting a campaign; shared by submit and run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "coordinator/campaign.hpp"
#include "coordinator/cli/farm_link.hpp"
#include "coordinator/cli/farm_verbs.hpp"

namespace fracfarm::cli {

// The answer of the farm (schema fracfarm.submit/1) where it went well; otherwise printed, with the exit status.
Answered submit(FarmLink& link, const Campaign& campaign, bool json);

std::string submitted_text(const nlohmann::json& answer);

}  // namespace fracfarm::cli
