// Which READY jobs a worker gets: pure functions of candidates, the worker and what is learned. Order: priority, then id.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "coordinator/job.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {

inline constexpr std::uint64_t enough_history = 20;  // results of a class before its p99 is believed
inline constexpr double history_margin = 1.5;        // of the p99
inline constexpr double flush_s = 10.0;              // to judge, append, sync and report a record
inline constexpr int most_jobs_a_claim = 1024;
inline constexpr int most_jobs_a_slot = 32;  // of one claim, whatever a worker asks for

struct Candidate {
  std::int64_t job = 0;
  JobClass job_class;
  double wall_budget_s = 0.0;
  std::set<std::string> failed_on;  // nodes where a try of it ended in a fault
};

struct Claimant {
  std::string node;
  int free_slots = 0;
  double remaining_s = -1.0;  // < 0: unlimited
};

// Seconds that a try may take at most: the learned p99 with a margin, or the hard budget.
double longest_s(const Candidate& job, const std::map<JobClass, Learned>& learned);

// True where one of `nodes` has not yet failed the job, so that `claimant` may leave it to that one.
bool better_elsewhere(const Candidate& job, const Claimant& claimant, const std::set<std::string>& nodes);

// Indices of the candidates to hand out, in order, at most free_slots.
std::vector<std::size_t> claim(std::span<const Candidate> candidates, const Claimant& claimant, const std::map<JobClass, Learned>& learned,
                               const std::set<std::string>& nodes);

}  // namespace fracfarm
