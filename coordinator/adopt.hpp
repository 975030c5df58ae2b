// Records that the ledger does not know become its results: after a restore, or to make a ledger from shards alone. What a record says was
// checked before it comes here; its bytes stay where they lie.
#pragma once

#include <vector>

#include "common/scene/scene.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/ledger.hpp"

namespace fracfarm {

struct FoundRecord {
  std::string key;
  std::string build_id;
  Scene scene;
  Outcome outcome;  // its place included
};

struct Adoption {
  std::uint64_t known = 0;    // DONE in the ledger already
  std::uint64_t adopted = 0;  // now DONE: a job of a campaign of the ledger
  std::uint64_t loose = 0;    // now DONE: of no campaign that the ledger has; the campaign "rebuilt" holds them
};

// In the caller's transaction; the rest are `loose`, for add_loose.
void adopt(Ledger& ledger, CampaignBook& book, const FoundRecord& record, Adoption& count, std::vector<FoundRecord>& loose);
void add_loose(Ledger& ledger, const std::vector<FoundRecord>& loose, double wall_s);

}  // namespace fracfarm
