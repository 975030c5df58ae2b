#include "coordinator/adopt.hpp"

#include <fmt/format.h>

#include <map>

#include "common/scene/parse.hpp"
#include "coordinator/enrolment.hpp"

namespace fracfarm {
namespace {

JobClass class_of(const Scene& scene) {
  return {std::string(name_of(scene.method)), material_name(scene), scene.sample ? scene.sample->load : "scene"};
}

// Index of a pattern within a block, or nothing.
std::optional<std::uint64_t> pattern_index(const JobBlock& block, CrackSet set, std::uint64_t id) {
  std::uint64_t index = 0;
  for (const IdRange& range : block.patterns) {
    if (range.set == set && id >= range.first && id <= range.last) return index + id - range.first;
    index += range.last - range.first + 1;
  }
  return std::nullopt;
}

// The untouched job that has this scene and key.
std::optional<std::int64_t> untouched_like(Ledger& ledger, CampaignBook& book, const FoundRecord& record) {
  if (!record.scene.sample) return std::nullopt;
  const Sample& sample = *record.scene.sample;
  const JobClass job_class = class_of(record.scene);
  for (const CampaignRow& row : campaign_rows(ledger.reading())) {
    if (row.first_id == 0 || row.build_id != record.build_id) continue;
    const auto campaign = book.open(ledger.reading(), row.id);
    if (!campaign || (*campaign)->seed != sample.seed) continue;
    for (const Series& series : series_of(**campaign)) {
      if (std::string(name_of(series.first.method)) != job_class.method || series.first.load != sample.load) continue;
      const auto index = pattern_index((*campaign)->blocks[series.block], sample.set, sample.id);
      if (!index) continue;
      const std::int64_t id = row.first_id + static_cast<std::int64_t>(series.position + *index * series.stride);
      const std::optional<Lane> lane = lane_of(ledger.reading(), id);
      if (!lane) continue;
      const Result<Untouched> made = untouched_job(ledger.reading(), book, *lane, id);
      if (made && made->job.key == record.key) return id;
    }
  }
  return std::nullopt;
}

}  // namespace

void adopt(Ledger& ledger, CampaignBook& book, const FoundRecord& record, Adoption& count, std::vector<FoundRecord>& loose) {
  std::optional<Job> job = job_by_key(ledger.reading(), record.key);
  if (!job)
    if (const auto id = untouched_like(ledger, book, record)) job = touch(ledger, book, *id);
  if (!job) return loose.push_back(record);
  if (job->state == State::done) {
    ++count.known;
    return;
  }
  ledger.complete(*job, record.outcome, {}, 0);
  ++count.adopted;
}

void add_loose(Ledger& ledger, const std::vector<FoundRecord>& loose, double wall_s) {
  std::map<std::string, std::vector<const FoundRecord*>> by_build;
  for (const FoundRecord& record : loose) by_build[record.build_id].push_back(&record);
  for (const auto& [build_id, records] : by_build) {
    const std::string text = fmt::format(R"({{"rebuilt":{}}})", campaign_rows(ledger.reading()).size() + 1);
    const std::int64_t campaign = ledger.add_campaign("rebuilt", text, build_id, records.size(), wall_s);
    const std::int64_t first = ledger.place_campaign(campaign);
    std::uint64_t position = 0, shared = 0;
    for (const FoundRecord* record : records) {
      const auto& sample = record->scene.sample;
      NewJob job{record->key,
                 campaign,
                 position,
                 class_of(record->scene),
                 std::string(name_of(sample ? sample->set : CrackSet::orthogonal)),
                 sample ? sample->id : 0};
      job.id = first + static_cast<std::int64_t>(position++);
      if (ledger.add_job(job))
        ledger.complete(job_by_id(ledger.reading(), job.id).value(), record->outcome, {}, 0);
      else
        ++shared;  // two records of one key: the first counts
    }
    ledger.advance_campaign(campaign, records.size(), shared);
  }
}

}  // namespace fracfarm
