// The campaigns of a ledger, parsed once, and the jobs of theirs that nobody has touched: made from the campaign whenever one is asked for,
// and a row of the ledger from the first time that something happens to it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "common/base/result.hpp"
#include "coordinator/campaign.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/scene_template.hpp"

namespace fracfarm {

class CampaignBook {
 public:
  // Errors: BAD_REQUEST where the ledger has no such campaign or its text is not one that this program reads.
  Result<std::shared_ptr<const Campaign>> open(Database& ledger, std::int64_t id);
  const std::string& build_id(std::int64_t id) const { return known_.at(id).build_id; }  // of one that was opened

  // The canonical text of the scene of a job of a campaign that was opened.
  std::string scene_text(std::int64_t id, std::uint64_t position);

 private:
  struct Entry {
    std::shared_ptr<const Campaign> campaign;
    std::string build_id;
    // By block, material, load and settings; empty where the series has none.
    std::map<std::string, std::optional<SceneTemplate>> templates = {};
  };
  std::map<std::int64_t, Entry> known_;
};

// The same by the scene grammar alone.
std::string scene_text(const Campaign& campaign, std::uint64_t position);

struct Untouched {
  NewJob job;         // of its lane's state
  std::string scene;  // canonical text
};
// `job` is one of the lane's. Errors: as CampaignBook::open.
Result<Untouched> untouched_job(Database& ledger, CampaignBook& book, const Lane& lane, std::int64_t job);

// The job as it stands, whether it has been touched or not; nothing where there is none of this id.
std::optional<Job> look_up(Database& ledger, CampaignBook& book, std::int64_t id);

// The same, as a row of the ledger from now on. Nothing also where the ledger turns out to have its key already.
std::optional<Job> touch(Ledger& ledger, CampaignBook& book, std::int64_t id);

// Jobs by id, touched or not; at most filter.limit.
std::vector<Job> list_jobs(Database& ledger, CampaignBook& book, const JobFilter& filter);

}  // namespace fracfarm
