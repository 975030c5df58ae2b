#include "coordinator/retry_policy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fracfarm {
namespace {

int count_of(std::span<const AttemptRow> history, std::string_view fault) {
  return static_cast<int>(std::count_if(history.begin(), history.end(), [&](const AttemptRow& row) { return row.fault == fault; }));
}

int counted(std::span<const AttemptRow> history) {
  return static_cast<int>(
      std::count_if(history.begin(), history.end(), [](const AttemptRow& row) { return counts_against_job(*fault_by_name(row.fault)); }));
}

// An earlier fault of the same class and signature on another node, or null.
const AttemptRow* same_elsewhere(std::span<const AttemptRow> history) {
  const AttemptRow& last = history.back();
  if (last.signature.empty()) return nullptr;
  for (const AttemptRow& row : history.first(history.size() - 1))
    if (row.fault == last.fault && row.signature == last.signature && row.node != last.node) return &row;
  return nullptr;
}

RetryDecision quarantined(std::string why) { return {State::quarantined, 0.0, 1.0, std::move(why)}; }

}  // namespace

bool counts_against_job(Fault fault) { return fault_row(fault).job_budget > 0 && fault != Fault::node_lost; }

bool is_job_reason(Fault fault) { return counts_against_job(fault) || fault == Fault::bad_request; }

double backoff_s(int faults, std::int64_t job) {
  const double spread =
      0.75 + 0.5 * static_cast<double>((static_cast<std::uint64_t>(job) * 0x9E3779B97F4A7C15ull) >> 40) / static_cast<double>(1 << 24);
  return spread * std::min(300.0, std::exp2(std::clamp(faults - 1, 0, 20)));
}

RetryDecision decide_retry(const Job& job, std::span<const AttemptRow> history, int attempts) {
  const Fault fault = *fault_by_name(history.back().fault);
  const FaultRow& row = fault_row(fault);
  if (row.action == FaultAction::ready_at_once) return {State::ready, 0.0, job.step_scale, "stopped as planned: nothing is counted"};
  if (row.action == FaultAction::quarantine) return quarantined(fmt::format("{}: trying again cannot help", row.name));
  if (row.action == FaultAction::done_censored) return quarantined("its budget was reached and no record came");
  const int faults = count_of(history, row.name);
  if (faults > row.job_budget) return quarantined(fmt::format("{} {} times; a job may end so {} times", row.name, faults, row.job_budget));
  if (counts_against_job(fault) && counted(history) >= attempts)
    return quarantined(fmt::format("{} attempts failed; the campaign allows {}", counted(history), attempts));
  const bool halve = row.action == FaultAction::half_step, enlarge = row.action == FaultAction::more_memory;
  if (fault != Fault::node_lost && !halve && !enlarge)
    if (const AttemptRow* other = same_elsewhere(history))
      return quarantined(fmt::format("{} with the same signature '{}' on {} and {}: the job is to blame, not a node", row.name,
                                     other->signature, other->node, history.back().node));
  const std::string_view how = halve     ? "again with half the time step"
                               : enlarge ? "again, where a slot has more memory if there is such a node"
                                         : "again, on another node where there is one";
  return {State::retry_wait, backoff_s(faults, job.id), halve ? 0.5 * job.step_scale : job.step_scale,
          fmt::format("{} {} of {}: {}", row.name, faults, row.job_budget, how), enlarge};
}

}  // namespace fracfarm
