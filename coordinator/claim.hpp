// Which READY jobs a worker gets: pure functions of candidates, the worker and what is learned. Order: priority, then id. A job that does
// not fit the time or the memory of one worker is left to another, and shorter jobs fill what is left of an allocation.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/job.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {

inline constexpr std::uint64_t enough_history = 20;  // results of a class before its p99 is believed
inline constexpr double history_margin = 1.5;        // of the p99 on nodes of the same type
inline constexpr double other_type_margin = 2.0;     // of the p99 over all nodes, where this type has too few results
inline constexpr double flush_s = 10.0;              // to judge, append, sync and report a record
inline constexpr int most_jobs_a_claim = 1024;
inline constexpr int most_jobs_a_slot = 32;  // of one claim, whatever a worker asks for

// What is learned of run times, by class and by class and type of node.
struct LearnedTimes {
  std::map<JobClass, Learned> all;
  std::map<std::pair<JobClass, std::string>, Learned> by_node;
};

struct Candidate {
  std::int64_t job = 0;
  JobClass job_class;
  double wall_budget_s = 0.0;
  std::set<std::string> failed_on;  // nodes where a try of it ended in a fault
  std::uint64_t memory_floor = 0;   // bytes a slot must have more than
};

struct Claimant {
  std::string node;
  int free_slots = 0;
  double remaining_s = -1.0;  // < 0: unlimited
  std::string node_type = {};
  int slots = 0;                  // 0: as many as are free
  std::uint64_t slot_memory = 0;  // bytes
  std::uint64_t most_memory = 0;  // bytes of a slot of the largest node there is
};

// Seconds that a try may take at most: the learned p99 with a margin, or the hard budget; with what it takes to keep the record.
struct LongestTry {
  double seconds = 0.0;
  bool learned = false;  // false: too few results, the whole budget counts
};
LongestTry longest_try(const JobClass& job_class, double wall_budget_s, const LearnedTimes& learned, const std::string& node_type);
double longest_s(const Candidate& job, const std::map<JobClass, Learned>& learned);  // without regard to the node

// True where one of `nodes` has not yet failed the job, so that `claimant` may leave it to that one.
bool better_elsewhere(const Candidate& job, const Claimant& claimant, const std::set<std::string>& nodes);
// True where another node has the memory that the job wants and this one has not.
bool larger_elsewhere(std::uint64_t memory_floor, const Claimant& claimant);

// Fills a worker's claim: says of one job after the other whether it still fits behind those before it.
class Claim {
 public:
  Claim(const Claimant& claimant, const LearnedTimes& learned) : claimant_(claimant), learned_(learned) {}
  bool fits(const JobClass& job_class, double wall_budget_s) const;
  void take(const JobClass& job_class, double wall_budget_s);
  int left() const;  // jobs that it may still get

 private:
  int slots() const;
  double starts_in_s() const;
  Claimant claimant_;
  const LearnedTimes& learned_;
  int taken_ = 0;
  double queued_s_ = 0.0;  // of the jobs taken, one after the other
};

// Indices of the candidates to hand out, in order, at most free_slots.
std::vector<std::size_t> claim(std::span<const Candidate> candidates, const Claimant& claimant, const std::map<JobClass, Learned>& learned,
                               const std::set<std::string>& nodes);

}  // namespace fracfarm
