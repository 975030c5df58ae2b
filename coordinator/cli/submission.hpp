// Submitting a campaign and waiting until it has been made jobs; shared by submit and run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "coordinator/campaign.hpp"
#include "coordinator/cli/farm_link.hpp"
#include "coordinator/cli/farm_verbs.hpp"

namespace fracfarm::cli {

// The last answer of the farm (schema fracfarm.submit/1) where it went well; otherwise printed, with the exit status.
Answered submit_and_wait(FarmLink& link, const Campaign& campaign, bool json);

std::string submitted_text(const nlohmann::json& answer);

}  // namespace fracfarm::cli
