#include "coordinator/enrolment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/hash.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

std::uint64_t pattern_count(const JobBlock& block) {
  std::uint64_t count = 0;
  for (const IdRange& range : block.patterns) count += range.last - range.first + 1;
  return count;
}

std::uint64_t variant_count(const JobBlock& block) {
  std::uint64_t count = block.materials.size() * block.loads.size();
  for (const SettingAxis& axis : block.set) count *= axis.values.size();
  return count;
}

// Parts of first..last that none of `taken` covers.
std::vector<Span> left_over(Span whole, std::vector<Span> taken) {
  std::sort(taken.begin(), taken.end(), [](const Span& a, const Span& b) { return a.first < b.first; });
  std::vector<Span> left;
  std::uint64_t at = whole.first;
  for (const Span& it : taken) {
    if (it.last < at || it.first > whole.last) continue;
    if (it.first > at) left.push_back({at, it.first - 1});
    at = it.last + 1;
  }
  if (at <= whole.last) left.push_back({at, whole.last});
  return left;
}

std::vector<Span> left_over_all(const std::vector<Span>& spans, Span taken) {
  std::vector<Span> left;
  for (const Span& it : spans)
    for (const Span& part : left_over(it, {taken})) left.push_back(part);
  return left;
}

std::uint64_t size_of(const std::vector<Span>& spans) {
  std::uint64_t n = 0;
  for (const Span& it : spans) n += it.last - it.first + 1;
  return n;
}

// The blocks that have a series like `identity`, kept alive by their campaigns.
struct Others {
  std::vector<std::shared_ptr<const Campaign>> campaigns;
  std::vector<SeriesPlace> places;
  std::vector<const JobBlock*> blocks() const {
    std::vector<const JobBlock*> list;
    for (std::size_t at = 0; at < places.size(); ++at) list.push_back(&campaigns[at]->blocks.at(places[at].block));
    return list;
  }
};

Result<Others> others_like(Database& ledger, CampaignBook& book, const std::string& identity) {
  Others others;
  for (const SeriesPlace& place : series_places(ledger, identity)) {
    const auto campaign = book.open(ledger, place.campaign);
    if (!campaign) return tl::unexpected(campaign.error());
    others.campaigns.push_back(*campaign);
    others.places.push_back(place);
  }
  return others;
}

// Position of the job of `pattern`, an index within the block, in its campaign.
std::uint64_t position_of(const Campaign& campaign, const SeriesPlace& place, std::uint64_t pattern) {
  std::uint64_t position = place.variant;
  for (std::size_t block = 0; block < place.block; ++block)
    position += pattern_count(campaign.blocks[block]) * variant_count(campaign.blocks[block]);
  return position + pattern * variant_count(campaign.blocks[place.block]);
}

// DONE jobs of a whole class of a campaign, by the counters; nothing where the class has more than this series.
std::optional<std::uint64_t> counted_done(Database& ledger, const Campaign& campaign, const SeriesPlace& place) {
  const auto class_of = [](const Series& it) { return JobClass{std::string(name_of(it.first.method)), it.first.material, it.first.load}; };
  const std::vector<Series> all = series_of(campaign);
  const auto own =
      std::find_if(all.begin(), all.end(), [&](const Series& it) { return it.block == place.block && it.variant == place.variant; });
  const JobClass job_class = class_of(*own);
  if (std::count_if(all.begin(), all.end(), [&](const Series& it) { return class_of(it) == job_class; }) != 1) return std::nullopt;
  std::uint64_t done = 0;
  for (const CountRow& row : count_rows(ledger))
    if (row.campaign == place.campaign && row.state == State::done && row.job_class == job_class) done += row.n;
  return done;
}

std::uint64_t done_in(Database& ledger, const Others& others, const JobBlock& wanted) {
  std::uint64_t done = 0;
  for (std::size_t at = 0; at < others.places.size(); ++at) {
    const SeriesPlace& place = others.places[at];
    const JobBlock& block = others.campaigns[at]->blocks.at(place.block);
    const std::optional<CampaignRow> row = campaign_row(ledger, place.campaign);
    const std::vector<Span> whole{{0, pattern_count(block) - 1}};
    const std::vector<Span> common = left_over(whole.front(), patterns_outside(block, {&wanted}));
    if (common == whole)
      if (const auto counted = counted_done(ledger, *others.campaigns[at], place)) {
        done += *counted;
        continue;
      }
    for (const Span& it : common)
      done += count_done(ledger, row->first_id + static_cast<std::int64_t>(position_of(*others.campaigns[at], place, it.first)),
                         row->first_id + static_cast<std::int64_t>(position_of(*others.campaigns[at], place, it.last)),
                         static_cast<std::int64_t>(variant_count(block)));
  }
  return done;
}

// How many of a series' patterns have a position below `position`.
std::uint64_t patterns_below(const Series& series, std::uint64_t position) {
  if (position <= series.position) return 0;
  return std::min(series.patterns, (position - series.position + series.stride - 1) / series.stride);
}

}  // namespace

std::vector<Series> series_of(const Campaign& campaign) {
  std::vector<Series> list;
  std::uint64_t position = 0;
  for (std::size_t block = 0; block < campaign.blocks.size(); ++block) {
    const std::uint64_t patterns = pattern_count(campaign.blocks[block]), variants = variant_count(campaign.blocks[block]);
    for (std::uint64_t variant = 0; variant < variants; ++variant)
      list.push_back({block, variant, job_at(campaign, position + variant), position + variant, variants, patterns});
    position += patterns * variants;
  }
  return list;
}

// The scene of one fixed pattern says everything about a series but how patterns are drawn: by the seed and `redraw`.
std::string identity_of(const Campaign& campaign, const Series& series, const std::string& build_id) {
  JobSpec probe = series.first;
  probe.set = CrackSet::orthogonal;
  probe.sample_id = 1;
  const std::string text = fmt::format("{}\n{}\n{}\n{}", canonical_text(scene_of(campaign, probe)), campaign.seed,
                                       campaign.blocks[series.block].redraw, build_id);
  return bytes_of_hex(sha256_hex(text)).substr(0, 16);
}

std::vector<Span> patterns_outside(const JobBlock& block, const std::vector<const JobBlock*>& others) {
  std::vector<Span> outside;
  std::uint64_t index = 0;
  for (const IdRange& range : block.patterns) {
    std::vector<Span> taken;
    for (const JobBlock* other : others)
      for (const IdRange& it : other->patterns)
        if (it.set == range.set) taken.push_back({it.first, it.last});
    for (const Span& ids : left_over({range.first, range.last}, std::move(taken))) {
      const Span span{index + ids.first - range.first, index + ids.last - range.first};
      if (!outside.empty() && outside.back().last + 1 == span.first)
        outside.back().last = span.last;
      else
        outside.push_back(span);
    }
    index += range.last - range.first + 1;
  }
  return outside;
}

Result<void> enrol(Ledger& ledger, CampaignBook& book, std::int64_t id) {
  const CampaignRow row = campaign_row(ledger.reading(), id).value();
  if (row.expanded == row.total) return {};
  const auto campaign = book.open(ledger.reading(), id);
  if (!campaign) return tl::unexpected(campaign.error());
  const std::int64_t first_id = ledger.place_campaign(id);
  std::uint64_t shared = 0;
  for (const Series& series : series_of(**campaign)) {
    const std::string identity = identity_of(**campaign, series, row.build_id);
    const Result<Others> others = others_like(ledger.reading(), book, identity);
    if (!others) return tl::unexpected(others.error());
    const std::uint64_t made = patterns_below(series, row.expanded);
    std::vector<Span> own = patterns_outside((*campaign)->blocks[series.block], others->blocks());
    if (made > 0) own = left_over_all(own, {0, made - 1});
    shared += series.patterns - made - size_of(own);
    const auto stride = static_cast<std::int64_t>(series.stride);
    for (const Span& it : own) {
      Lane lane{.campaign = id, .job_class = {std::string(name_of(series.first.method)), series.first.material, series.first.load}};
      lane.stride = stride;
      lane.next = first_id + static_cast<std::int64_t>(series.position) + static_cast<std::int64_t>(it.first) * stride;
      lane.last = first_id + static_cast<std::int64_t>(series.position) + static_cast<std::int64_t>(it.last) * stride;
      ledger.add_lane(lane);
    }
    ledger.add_series(identity, {id, series.block, series.variant});
  }
  ledger.advance_campaign(id, row.total, shared);
  return {};
}

Result<void> enrol_the_rest(Ledger& ledger) {
  CampaignBook book;
  for (const CampaignRow& row : campaign_rows(ledger.reading())) {
    if (row.expanded == row.total) continue;
    ledger.begin();
    if (Result<void> made = enrol(ledger, book, row.id); !made) return ledger.rollback(), made;
    ledger.commit();
  }
  return {};
}

Known known_jobs(Database& ledger, CampaignBook& book, const Campaign& campaign, const std::string& build_id) {
  Known known;
  for (const Series& series : series_of(campaign)) {
    const Result<Others> others = others_like(ledger, book, identity_of(campaign, series, build_id));
    if (!others) continue;
    const JobBlock& block = campaign.blocks[series.block];
    known.present += series.patterns - size_of(patterns_outside(block, others->blocks()));
    known.done += done_in(ledger, *others, block);
  }
  return known;
}

}  // namespace fracfarm
