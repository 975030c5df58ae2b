// The canonical texts of a series' scenes, fast: jobs of one series differ in their cracks and sample alone, so one text is made by the
// scene grammar and the rest by writing those two in. A series for which that does not hold is found out by comparing, and goes the slow
// way.
#pragma once

#include <optional>
#include <string>

#include "coordinator/campaign.hpp"

namespace fracfarm {

class SceneTemplate {
 public:
  // Of the series that `job` belongs to; nothing where the texts of a few patterns do not come out as canonical_text has them.
  static std::optional<SceneTemplate> make(const Campaign& campaign, const JobSpec& job);

  std::string text(CrackSet set, std::uint64_t sample_id) const;  // canonical

 private:
  static std::optional<SceneTemplate> cut(const Campaign& campaign, const JobSpec& job);
  std::string before_, between_, after_;  // the cracks, then the sample
  bool has_cracks_ = false;
  std::string load_;
  std::uint64_t seed_ = 0;
  PatternSettings pattern_;
};

}  // namespace fracfarm
