#include "coordinator/claim.hpp"

#include <algorithm>

namespace fracfarm {

LongestTry longest_try(const JobClass& job_class, double wall_budget_s, const LearnedTimes& learned, const std::string& node_type) {
  const auto here = learned.by_node.find({job_class, node_type});
  if (here != learned.by_node.end() && here->second.n >= enough_history)
    return {std::min(wall_budget_s, history_margin * here->second.p99_s) + flush_s, true};
  const auto anywhere = learned.all.find(job_class);
  if (anywhere != learned.all.end() && anywhere->second.n >= enough_history)
    return {std::min(wall_budget_s, other_type_margin * anywhere->second.p99_s) + flush_s, true};
  return {wall_budget_s + flush_s, false};
}

double longest_s(const Candidate& job, const std::map<JobClass, Learned>& learned) {
  const auto known = learned.find(job.job_class);
  if (known == learned.end() || known->second.n < enough_history) return job.wall_budget_s + flush_s;
  return std::min(job.wall_budget_s, history_margin * known->second.p99_s) + flush_s;
}

bool better_elsewhere(const Candidate& job, const Claimant& claimant, const std::set<std::string>& nodes) {
  if (!job.failed_on.contains(claimant.node)) return false;
  return std::any_of(nodes.begin(), nodes.end(), [&](const std::string& node) { return !job.failed_on.contains(node); });
}

bool larger_elsewhere(std::uint64_t memory_floor, const Claimant& claimant) {
  return memory_floor > 0 && claimant.slot_memory <= memory_floor && claimant.most_memory > memory_floor;
}

int Claim::left() const { return std::clamp(claimant_.free_slots, 0, most_jobs_a_claim) - taken_; }

int Claim::slots() const { return std::max(1, claimant_.slots > 0 ? claimant_.slots : claimant_.free_slots); }

// A job behind those that fill the slots waits for them.
double Claim::starts_in_s() const { return taken_ < slots() ? 0.0 : queued_s_ / slots(); }

bool Claim::fits(const JobClass& job_class, double wall_budget_s) const {
  if (claimant_.remaining_s < 0.0) return true;
  return starts_in_s() + longest_try(job_class, wall_budget_s, learned_, claimant_.node_type).seconds <= claimant_.remaining_s;
}

void Claim::take(const JobClass& job_class, double wall_budget_s) {
  ++taken_;
  if (claimant_.remaining_s >= 0.0) queued_s_ += longest_try(job_class, wall_budget_s, learned_, claimant_.node_type).seconds;
}

std::vector<std::size_t> claim(std::span<const Candidate> candidates, const Claimant& claimant, const std::map<JobClass, Learned>& learned,
                               const std::set<std::string>& nodes) {
  const LearnedTimes times{learned, {}};
  Claim taking(claimant, times);
  std::vector<std::size_t> chosen;
  for (std::size_t at = 0; at < candidates.size() && taking.left() > 0; ++at) {
    const Candidate& it = candidates[at];
    if (!taking.fits(it.job_class, it.wall_budget_s) || better_elsewhere(it, claimant, nodes)) continue;
    if (larger_elsewhere(it.memory_floor, claimant)) continue;
    taking.take(it.job_class, it.wall_budget_s);
    chosen.push_back(at);
  }
  return chosen;
}

}  // namespace fracfarm
