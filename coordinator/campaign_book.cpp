#include "coordinator/campaign_book.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

Job job_of(const NewJob& it) {
  Job job;
  job.id = it.id;
  job.key = it.key;
  job.campaign = it.campaign;
  job.position = it.position;
  job.job_class = it.job_class;
  job.crack_set = it.crack_set;
  job.sample_id = it.sample_id;
  job.state = it.state;
  job.priority = it.priority;
  return job;
}

// The first ids after `after` of all lanes, at most `limit`, each with its lane.
std::vector<std::pair<std::int64_t, const Lane*>> first_ids(const std::vector<Lane>& lanes, std::int64_t after, std::size_t limit) {
  std::vector<std::pair<std::int64_t, const Lane*>> ids;
  for (const Lane& lane : lanes) {
    std::int64_t id = lane.next;
    if (after >= id) id += (after - id) / lane.stride * lane.stride + lane.stride;
    for (std::size_t n = 0; n < limit && id <= lane.last; ++n, id += lane.stride) ids.emplace_back(id, &lane);
  }
  std::sort(ids.begin(), ids.end());
  ids.resize(std::min(ids.size(), limit));
  return ids;
}

}  // namespace

Result<std::shared_ptr<const Campaign>> CampaignBook::open(Database& ledger, std::int64_t id) {
  if (const auto known = known_.find(id); known != known_.end()) return known->second.campaign;
  const std::optional<CampaignRow> row = campaign_row(ledger, id);
  if (!row) return fail(Fault::bad_request, fmt::format("the ledger has no campaign {}", id));
  Parsed<Campaign> campaign = parse_campaign(row->text, row->name);
  if (!campaign) {
    const Problem& first = campaign.error().front();
    return fail(Fault::bad_request, fmt::format("the ledger's campaign {} is not one that this program reads: {} = {}; allowed: {}",
                                                row->name, first.key, first.value, first.limit));
  }
  return (known_[id] = {std::make_shared<const Campaign>(std::move(*campaign)), row->build_id}).campaign;
}

std::string CampaignBook::scene_text(std::int64_t id, std::uint64_t position) {
  Entry& entry = known_.at(id);
  const JobSpec spec = job_at(*entry.campaign, position);
  std::string series = fmt::format("{} {} {}", spec.block, spec.material, spec.load);
  for (const auto& [key, value] : spec.settings) series += fmt::format(" {}", value);
  auto known = entry.templates.find(series);
  if (known == entry.templates.end()) known = entry.templates.emplace(std::move(series), SceneTemplate::make(*entry.campaign, spec)).first;
  if (known->second) return known->second->text(spec.set, spec.sample_id);
  return canonical_text(scene_of(*entry.campaign, spec));
}

std::string scene_text(const Campaign& campaign, std::uint64_t position) {
  return canonical_text(scene_of(campaign, job_at(campaign, position)));
}

Result<Untouched> untouched_job(Database& ledger, CampaignBook& book, const Lane& lane, std::int64_t job) {
  const auto campaign = book.open(ledger, lane.campaign);
  if (!campaign) return tl::unexpected(campaign.error());
  const auto position = static_cast<std::uint64_t>(job - lane.first_id);
  const JobSpec spec = job_at(**campaign, position);
  Untouched made;
  made.scene = book.scene_text(lane.campaign, position);
  made.job = {job_key(made.scene, book.build_id(lane.campaign)),
              lane.campaign,
              position,
              lane.job_class,
              std::string(name_of(spec.set)),
              spec.sample_id,
              job,
              lane.state,
              lane.priority};
  return made;
}

std::optional<Job> look_up(Database& ledger, CampaignBook& book, std::int64_t id) {
  if (std::optional<Job> job = job_by_id(ledger, id)) return job;
  const std::optional<Lane> lane = lane_of(ledger, id);
  if (!lane) return std::nullopt;
  const Result<Untouched> made = untouched_job(ledger, book, *lane, id);
  if (!made) return std::nullopt;
  return job_of(made->job);
}

std::optional<Job> touch(Ledger& ledger, CampaignBook& book, std::int64_t id) {
  if (std::optional<Job> job = job_by_id(ledger.reading(), id)) return job;
  const std::optional<Lane> lane = lane_of(ledger.reading(), id);
  if (!lane) return std::nullopt;
  const Result<Untouched> made = untouched_job(ledger.reading(), book, *lane, id);
  if (!made) return std::nullopt;
  ledger.take_from_lane(*lane, id);
  if (ledger.add_job(made->job)) return job_of(made->job);
  ledger.count_shared(lane->campaign);
  return std::nullopt;
}

std::vector<Job> list_jobs(Database& ledger, CampaignBook& book, const JobFilter& filter) {
  std::vector<Job> jobs = jobs_where(ledger, filter);
  const std::vector<Lane> lanes = lanes_where(ledger, filter);
  for (const auto& [id, lane] : first_ids(lanes, filter.after, static_cast<std::size_t>(filter.limit))) {
    const bool full = jobs.size() >= static_cast<std::size_t>(filter.limit);
    if (full && id > jobs[static_cast<std::size_t>(filter.limit) - 1].id) break;
    const Result<Untouched> made = untouched_job(ledger, book, *lane, id);
    if (!made) continue;
    jobs.insert(std::upper_bound(jobs.begin(), jobs.end(), id, [](std::int64_t a, const Job& b) { return a < b.id; }), job_of(made->job));
  }
  jobs.resize(std::min(jobs.size(), static_cast<std::size_t>(filter.limit)));
  return jobs;
}

}  // namespace fracfarm
