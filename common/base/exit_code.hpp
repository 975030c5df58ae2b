// Exit statuses of every program, so that scripts can trust them.
#pragma once

namespace fracfarm {

enum ExitCode : int {
  exit_ok = 0,
  exit_failed = 1,       // it ran and the answer is no: a broken rule, a lost daemon, a numerical failure
  exit_bad_input = 2,    // usage, scene or campaign mistakes; nothing was changed
  exit_stopped = 3,      // ended by a signal or a drain; run again to go on
  exit_unreachable = 4,  // no coordinator, no ledger, or held by another
  exit_quarantined = 5,  // the campaign ended, with quarantined jobs
};

}  // namespace fracfarm
