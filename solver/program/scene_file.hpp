// Scene files at the command line: read, and what is wrong with them in words or as JSON.
#pragma once

#include <string>

#include "common/base/result.hpp"

namespace fracfarm {

// The text of a scene file, or of standard input where the path is "-".
Result<std::string> scene_text(const std::string& path);

// All problems on standard error, or as one JSON object on standard output. Gives exit_bad_input.
int report_problems(const Problems& problems, const std::string& scene, bool json);

}  // namespace fracfarm
