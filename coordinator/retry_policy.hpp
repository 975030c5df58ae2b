// What becomes of a job whose try ended in a fault: a pure function of its history and the fault table. It moves nothing.
#pragma once

#include <span>
#include <string>

#include "common/base/fault.hpp"
#include "coordinator/job.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {

struct RetryDecision {
  State state = State::quarantined;  // READY, RETRY_WAIT or QUARANTINED
  double wait_s = 0.0;
  double step_scale = 1.0;
  std::string why;           // one sentence
  bool more_memory = false;  // than the slot had where it failed
};

// `history`: the job's faults that still count, oldest first, the newest included. `attempts`: the campaign's cap on all that count against
// the job.
RetryDecision decide_retry(const Job& job, std::span<const AttemptRow> history, int attempts);

// Seconds before try number n + 1: doubling from 1 s to 5 min, spread by the job's id so that a burst does not come back as one.
double backoff_s(int faults, std::int64_t job);

// Only what the job itself may be to blame for counts against a worker's claims and a campaign's attempts.
bool counts_against_job(Fault fault);

// What blows a class's fuse: a campaign that is wrong, not a machine.
bool is_job_reason(Fault fault);

}  // namespace fracfarm
