// The status of a farm as Prometheus text (exposition format 0.0.4): for a node exporter's textfile collector, or a cron job's curl.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fracfarm::cli {

std::string metrics_text(const nlohmann::json& status);  // of schema fracfarm.status/1

}  // namespace fracfarm::cli
