// What the verbs of a farm share: --farm and --json, reaching the farm, printing answers.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "coordinator/campaign.hpp"
#include "coordinator/cli/farm_link.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {

struct FarmOptions {
  std::filesystem::path farm = "farm";
  bool json = false;
};
void add_farm_options(Command& app, FarmOptions& options);

// Runs a verb's body; a failing ledger ends here, in words.
int guarded(const FarmOptions& options, const std::function<int()>& body);

// NODE_LOST is exit_unreachable here: there is no farm, or nobody answers.
int report_unreachable(const Error& error, bool json);

// Asks; prints errors and problems in words (or the whole answer with --json). Gives the body where the answer is what was asked for,
// else the exit status.
struct Answered {
  int exit_code = 0;
  std::string body;     // JSON text
  bool usable = false;  // to be printed for people
};
Answered ask_and_report(FarmLink& link, const std::string& verb, const nlohmann::json& arguments, bool json);

Parsed<Campaign> load_campaign(const std::filesystem::path& file);

}  // namespace fracfarm::cli
