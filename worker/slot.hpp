// One core's place for work: a solver child that is kept alive between jobs, given one task at a time, watched, and ended from outside
// where it does not end by itself. It judges no record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/clock.hpp"
#include "common/task/task.hpp"
#include "worker/child.hpp"
#include "worker/child_end.hpp"

namespace fracfarm::worker {

struct SlotOptions {
  std::filesystem::path solver;
  std::vector<std::string> arguments{"--serve"};
  std::uint64_t memory_limit = 0;  // bytes, 0: none
  double start_s = 30.0;           // from exec to `ready`
  double hang_s = 60.0;            // without a report while a task runs
  double stop_grace_s = 20.0;      // from SIGTERM to SIGKILL
  double budget_grace_s = 30.0;    // beyond the wall budget, for the solver to write its record
};

struct SlotReady {
  std::string build_id;
};
struct SlotProgress {
  long long step = 0;
};
struct SlotSolved {
  Summary summary;
};
struct SlotStopped {};  // the task ended with a checkpoint, or was abandoned; its child is gone
struct SlotFailed {
  Fault fault = Fault::solver_crash;
  std::string message;
  std::string signature;
};
using SlotEvent = std::variant<SlotReady, SlotProgress, SlotSolved, SlotStopped, SlotFailed>;

class Slot {
 public:
  Slot(SlotOptions options, Clock& clock);

  bool busy() const { return task_.has_value(); }
  // Starts a child where there is none; errors come as SlotFailed from step().
  void start(Task task);
  void warm_up();  // starts the child without a task: SlotReady, or SlotFailed, follows
  void stop();     // SIGTERM: the solver saves a checkpoint and ends
  void abandon();  // SIGKILL at once
  // Reads what is there, keeps the deadlines, sees ends. Never blocks.
  std::vector<SlotEvent> step();

  // Descriptors for poll(2) and when step() should be called at the latest (monotonic s).
  std::vector<int> descriptors() const;
  std::optional<int> write_descriptor() const;
  double next_deadline() const;
  pid_t pid() const { return child_ ? child_->pid() : -1; }

 private:
  bool ensure_child();
  void read_reports(std::vector<SlotEvent>& events);
  void hear(Report&& report, std::vector<SlotEvent>& events);
  void keep_deadlines();
  void see_end(std::vector<SlotEvent>& events);
  void kill(Killed why);
  void give(SlotEvent event) { early_.push_back(std::move(event)); }

  SlotOptions options_;
  Clock& clock_;
  std::optional<Child> child_;
  std::optional<Task> task_;
  std::vector<SlotEvent> early_;  // found between two steps
  bool ready_ = false;
  bool stopping_ = false;       // SIGTERM was sent
  bool stop_reported_ = false;  // it said `stopped`
  Killed killed_ = Killed::no;
  Killed stop_reason_ = Killed::no;  // what a kill after the grace is for
  double heard_at_ = 0.0;
  double started_at_ = 0.0;  // of the task
  double kill_at_ = 0.0;     // after SIGTERM
  std::uint64_t memory_kills_before_ = 0;
};

}  // namespace fracfarm::worker
