// What the verbs share that change something: asking, and saying what was done or with --dry-run would be.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "coordinator/cli/farm_verbs.hpp"

namespace fracfarm::cli {

struct ChangeWords {
  std::string_view did;     // "made ready:"
  std::string_view what;    // " job"
  std::string_view plural;  // "s"
};
int change(const FarmOptions& options, const std::string& verb, const nlohmann::json& arguments, const ChangeWords& words);

}  // namespace fracfarm::cli
