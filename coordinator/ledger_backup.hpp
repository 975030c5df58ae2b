// Copies of a ledger: made while it is in use, proved before they count, and put back in its place. A copy is one whole SQLite file.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/result.hpp"
#include "coordinator/ledger_folder.hpp"

namespace fracfarm {

// Copies the ledger as it stands at one moment; others may read and write it meanwhile. The copy is synced, opened again, checked page by
// page, and only then has its name. Errors: NODE_LOST where there is no ledger or no room, OUTPUT_BAD where the copy is not sound.
Result<void> back_up_ledger(const std::filesystem::path& ledger, const std::filesystem::path& copy);

// Is this file a sound ledger that this program can open? Errors: OUTPUT_BAD or BAD_REQUEST, in words.
Result<void> check_ledger_file(const std::filesystem::path& file);

// Puts a copy in the ledger's place; an earlier ledger stays beside it as ledger.db.before-restore. Errors: NODE_LOST where the ledger is
// held by another, as check_ledger_file where the copy is not sound.
Result<void> put_back_ledger(const FarmPaths& paths, const std::filesystem::path& copy);

// The farm's own copies, FARM/backups/ledger-UTC.db; all but the latest `keep` are removed. Gives the new one's name.
Result<std::filesystem::path> back_up_farm(const FarmPaths& paths, double wall_s, std::size_t keep = 3);

}  // namespace fracfarm
