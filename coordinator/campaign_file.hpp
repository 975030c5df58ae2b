// A campaign file as a JSON value, whether it was written in TOML or JSON, with the line of each key where TOML knows it.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

struct CampaignFile {
  std::shared_ptr<const nlohmann::json> value;
  std::map<std::string, int> lines;  // key path -> line, from 1; empty for JSON
  std::string name;

  // "campaign.toml:12: jobs[0].loads", or "campaign.json: ..." where no line is known: the nearest enclosing key's line counts.
  std::string place(std::string_view key) const;
};

// Bounds: 1 MB, 16 levels. Numbers that are not finite and TOML dates are refused here.
Parsed<CampaignFile> read_campaign_file(std::string_view text, std::string_view name);

}  // namespace fracfarm
