#include "coordinator/campaign_book.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/scene/parse.hpp"

namespace fracfarm {

Result<std::shared_ptr<const Campaign>> CampaignBook::open(Database& ledger, std::int64_t id) {
  if (const auto known = parsed_.find(id); known != parsed_.end()) return known->second;
  const std::optional<CampaignRow> row = campaign_row(ledger, id);
  if (!row) return fail(Fault::bad_request, fmt::format("the ledger has no campaign {}", id));
  Parsed<Campaign> campaign = parse_campaign(row->text, row->name);
  if (!campaign) {
    const Problem& first = campaign.error().front();
    return fail(Fault::bad_request, fmt::format("the ledger's campaign {} is not one that this program reads: {} = {}; allowed: {}",
                                                row->name, first.key, first.value, first.limit));
  }
  return parsed_[id] = std::make_shared<const Campaign>(std::move(*campaign));
}

std::string scene_text(const Campaign& campaign, std::uint64_t position) {
  return canonical_text(scene_of(campaign, job_at(campaign, position)));
}

Result<bool> expand_campaigns(Ledger& ledger, CampaignBook& book, std::uint64_t most) {
  const std::optional<CampaignRow> row = next_unexpanded(ledger.reading());
  if (!row) return false;
  const auto campaign = book.open(ledger.reading(), row->id);
  if (!campaign) return tl::unexpected(campaign.error());
  const std::uint64_t end = row->expanded + std::min(most, row->total - row->expanded);
  std::uint64_t shared = 0;
  for (std::uint64_t at = row->expanded; at < end; ++at) {
    const JobSpec spec = job_at(**campaign, at);
    const std::string key = job_key(canonical_text(scene_of(**campaign, spec)), row->build_id);
    const NewJob job{
        key, row->id, at, {std::string(name_of(spec.method)), spec.material, spec.load}, std::string(name_of(spec.set)), spec.sample_id};
    if (!ledger.add_job(job)) ++shared;
  }
  ledger.advance_campaign(row->id, end, shared);
  return true;
}

}  // namespace fracfarm
