// The campaigns of a ledger, parsed once, and how they become jobs: a stretch at a time, so that a large one never holds up the beats of
// workers.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "common/base/result.hpp"
#include "coordinator/campaign.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {

class CampaignBook {
 public:
  // Errors: BAD_REQUEST where the ledger has no such campaign or its text is not one that this program reads.
  Result<std::shared_ptr<const Campaign>> open(Database& ledger, std::int64_t id);

 private:
  std::map<std::int64_t, std::shared_ptr<const Campaign>> parsed_;
};

// The text of the scene of a job, canonical.
std::string scene_text(const Campaign& campaign, std::uint64_t position);

// Makes jobs of the next positions of the oldest unfinished campaign, at most `most`, in the caller's transaction. False: nothing was left
// to do.
Result<bool> expand_campaigns(Ledger& ledger, CampaignBook& book, std::uint64_t most);

}  // namespace fracfarm
