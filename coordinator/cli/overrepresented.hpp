// Which values stand out among the jobs that failed: pure counting and exact statistics. It says what goes together, not what is the cause.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace fracfarm::cli {

using Features = std::map<std::string, std::string>;  // of one job: material -> pbx, cracks -> 14, ...

struct Standing {
  std::string feature, value;
  std::uint64_t failed_with = 0, failed = 0;  // jobs
  std::uint64_t sound_with = 0, sound = 0;
  double lift = 0.0;             // share among the failed over share among all of the sample
  double low = 0.0, high = 0.0;  // 95 % Wilson interval of the share among the failed
  double p = 1.0;                // Fisher's exact test, one-sided, times the number of values looked at (Bonferroni), at most 1
};

// All values, the least likely to be chance first. `sound_weight`: jobs that each of `sound` stands for.
std::vector<Standing> standing_out(const std::vector<Features>& failed, const std::vector<Features>& sound, double sound_weight);

// P(at least `with` of `drawn` have it), where `total_with` of `total` do: the hypergeometric tail.
double fisher_tail(std::uint64_t with, std::uint64_t drawn, std::uint64_t total_with, std::uint64_t total);

struct Interval {
  double low = 0.0, high = 1.0;
};
Interval wilson(std::uint64_t hits, std::uint64_t n);  // 95 %; E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209

}  // namespace fracfarm::cli
