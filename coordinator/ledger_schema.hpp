// The ledger's tables and how an older ledger becomes today's. The counters are kept by triggers, so that no statement can change a state
// without its counter. A ledger of a later schema is refused in words.
#pragma once

#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "coordinator/ledger_sqlite.hpp"

namespace fracfarm {

// migrations()[n] takes a ledger of version n to n + 1; never edited once published.
std::span<const std::string_view> migrations();

// Runs what is missing, each in its own transaction. Errors: BAD_REQUEST where the ledger is of a later version.
Result<void> migrate(Database& database, std::span<const std::string_view> steps = migrations());

}  // namespace fracfarm
