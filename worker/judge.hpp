// The verdict on a closed record before it may enter a shard: every rule of the validator, and that it says what the solver's summary says.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "common/task/task.hpp"

namespace fracfarm::worker {

// Errors: OUTPUT_BAD whose message starts with the name of the first broken rule and holds all of them.
Result<void> judge_record(const std::string& bytes, const std::string& key, const Summary& summary);

}  // namespace fracfarm::worker
