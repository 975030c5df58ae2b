#include "coordinator/claim.hpp"

#include <algorithm>

namespace fracfarm {

double longest_s(const Candidate& job, const std::map<JobClass, Learned>& learned) {
  const auto known = learned.find(job.job_class);
  if (known == learned.end() || known->second.n < enough_history) return job.wall_budget_s + flush_s;
  return std::min(job.wall_budget_s, history_margin * known->second.p99_s) + flush_s;
}

bool better_elsewhere(const Candidate& job, const Claimant& claimant, const std::set<std::string>& nodes) {
  if (!job.failed_on.contains(claimant.node)) return false;
  return std::any_of(nodes.begin(), nodes.end(), [&](const std::string& node) { return !job.failed_on.contains(node); });
}

std::vector<std::size_t> claim(std::span<const Candidate> candidates, const Claimant& claimant, const std::map<JobClass, Learned>& learned,
                               const std::set<std::string>& nodes) {
  std::vector<std::size_t> chosen;
  const auto most = static_cast<std::size_t>(std::clamp(claimant.free_slots, 0, most_jobs_a_claim));
  for (std::size_t at = 0; at < candidates.size() && chosen.size() < most; ++at) {
    const bool fits = claimant.remaining_s < 0.0 || longest_s(candidates[at], learned) <= claimant.remaining_s;
    if (fits && !better_elsewhere(candidates[at], claimant, nodes)) chosen.push_back(at);
  }
  return chosen;
}

}  // namespace fracfarm
