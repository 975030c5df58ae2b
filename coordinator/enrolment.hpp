// How a campaign becomes jobs: not one by one but as a few lanes, so that two million take no longer than two. Jobs that an earlier
// campaign has already are left out by comparing what the campaigns are made of; the few that only their scenes show to be equal are left
// out when they are first touched, by their key.
#pragma once

#include "coordinator/campaign_book.hpp"
#include "coordinator/ledger.hpp"

namespace fracfarm {

// All jobs of one method, material, load and combination of settings of a block: they differ in their pattern alone.
struct Series {
  std::size_t block = 0;
  std::uint64_t variant = 0;   // which combination
  JobSpec first;               // of the first pattern
  std::uint64_t position = 0;  // of the first pattern's job in the campaign
  std::uint64_t stride = 1;    // positions from a pattern's job to the next pattern's
  std::uint64_t patterns = 0;
};
std::vector<Series> series_of(const Campaign& campaign);

// 16 bytes, equal where every job of equal pattern is equal. Costs one scene.
std::string identity_of(const Campaign& campaign, const Series& series, const std::string& build_id);

// Indices of a block's patterns, from first to last.
struct Span {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  bool operator==(const Span&) const = default;
};
// The patterns of `block` that none of `others` has, and those that one has.
std::vector<Span> patterns_outside(const JobBlock& block, const std::vector<const JobBlock*>& others);

// Makes the lanes of a campaign that add_campaign gave, for the jobs that it does not have yet. In the caller's transaction. Errors:
// BAD_REQUEST where the campaign cannot be read.
Result<void> enrol(Ledger& ledger, CampaignBook& book, std::int64_t campaign);

// The lanes of every campaign that a release of the first schema left half made: jobs that it made keep their ids, the others follow. In
// transactions of its own. Errors: as enrol.
Result<void> enrol_the_rest(Ledger& ledger);

// Of the jobs of a campaign, how many the ledger has, how many it has DONE. Counts, makes no scene but one a series.
struct Known {
  std::uint64_t present = 0;
  std::uint64_t done = 0;
};
Known known_jobs(Database& ledger, CampaignBook& book, const Campaign& campaign, const std::string& build_id);

}  // namespace fracfarm
