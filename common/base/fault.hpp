// The table of fault classes: what can go wrong operationally, whom it counts against, how often it is tried again.
// A fault is operational; a *failure* (of the material) is physics and lives in common/failure.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace fracfarm {

enum class Fault {
  planned_stop,
  node_lost,
  output_bad,
  solver_crash,
  solver_numeric,
  out_of_memory,
  budget,
  bad_request,
};

// What the coordinator does with a job after a fault of this class.
enum class FaultAction {
  ready_at_once,  // back to READY, nothing counted
  another_node,   // RETRY_WAIT with backoff, another node where there is one
  half_step,      // RETRY_WAIT once with half the time step
  more_memory,    // RETRY_WAIT, on a node with more memory for each slot where there is one
  done_censored,  // DONE(CENSORED): a valid result
  quarantine,     // QUARANTINED: a person must look
};

struct FaultRow {
  Fault fault;
  std::string_view name;  // as it is printed and stored
  int job_budget;         // attempts that may end so before the job is QUARANTINED; 0: never counted against the job
  bool node_suspected;    // the node may be to blame: it is, where other nodes do what fails on it
  FaultAction action;
  std::string_view meaning;  // one line for people
};

inline constexpr std::array<FaultRow, 8> fault_table{{
    {Fault::planned_stop, "PLANNED_STOP", 0, false, FaultAction::ready_at_once,
     "drain, preemption or the end of an allocation; the checkpoint is kept"},
    {Fault::node_lost, "NODE_LOST", 5, true, FaultAction::another_node,
     "heartbeat lost, bus error, disk full or a missing library on the node"},
    {Fault::output_bad, "OUTPUT_BAD", 3, true, FaultAction::another_node,
     "the record is truncated, reads back differently or breaks a rule"},
    {Fault::solver_crash, "SOLVER_CRASH", 3, true, FaultAction::another_node, "the solver ended by a signal or a non-zero exit, or hung"},
    {Fault::solver_numeric, "SOLVER_NUMERIC", 1, false, FaultAction::half_step, "not finite, energy ledger open or diverged"},
    {Fault::out_of_memory, "OUT_OF_MEMORY", 2, true, FaultAction::more_memory, "killed by the memory limit"},
    {Fault::budget, "BUDGET", 0, false, FaultAction::done_censored, "wall clock or step budget reached; the last checkpoint is kept"},
    {Fault::bad_request, "BAD_REQUEST", 0, false, FaultAction::quarantine, "the scene or campaign is not one that this build can solve"},
}};

constexpr const FaultRow& fault_row(Fault fault) { return fault_table[static_cast<std::size_t>(fault)]; }

constexpr std::optional<Fault> fault_by_name(std::string_view name) {
  for (const FaultRow& row : fault_table)
    if (row.name == name) return row.fault;
  return std::nullopt;
}

}  // namespace fracfarm
