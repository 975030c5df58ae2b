// Where the records of a farm lie, asked of whoever holds its ledger.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "common/base/result.hpp"
#include "coordinator/cli/farm_link.hpp"
#include "coordinator/shard_audit.hpp"

namespace fracfarm::cli {

// Places of the DONE jobs that `wanted` names, by job id. Errors: NODE_LOST where nobody answers.
Result<std::vector<RecordPlace>> record_places(FarmLink& link, const std::filesystem::path& farm,
                                               const std::function<bool(std::uint64_t job)>& wanted);

// The place of one job's record; nothing where it has none. Errors: NODE_LOST where nobody answers.
Result<std::optional<RecordPlace>> record_place(FarmLink& link, const std::filesystem::path& farm, std::uint64_t job);

}  // namespace fracfarm::cli
