// Which row of the fault table the end of a solver child is: a pure function of what was seen.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/fault.hpp"

namespace fracfarm::worker {

// Why the worker itself killed the child, if it did.
enum class Killed { no, hang, wall_budget, unreadable, grace, abandoned };

struct EndEvidence {
  int status = 0;  // as waitpid gives it
  Killed killed = Killed::no;
  std::uint64_t peak_rss = 0;      // bytes
  std::uint64_t memory_limit = 0;  // bytes, 0: none
  bool oom_kill_counted = false;   // the control group counted a kill for memory meanwhile
  std::string last_words;          // the end of its error output
};

struct Classified {
  Fault fault = Fault::solver_crash;
  std::string message;
  std::string signature;  // the same for the same cause on any node
};

Classified classify(const EndEvidence& end);

// Kills for memory that this process's control group (version 2) has counted; 0 where there is none to ask.
std::uint64_t memory_kills();

}  // namespace fracfarm::worker
