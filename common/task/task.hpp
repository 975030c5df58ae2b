// The pipe between a worker and its solver child: one JSON object a line, Task in, Report out. The same summary is what `fracfarm solve
// --json` prints.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/failure/failure.hpp"

namespace fracfarm {

inline constexpr std::string_view task_schema = "fracfarm.task/1";
inline constexpr std::string_view summary_schema = "fracfarm.summary/1";

// Worker -> child: solve this. Closing the pipe ends the child; SIGTERM makes it checkpoint, report `stopped` and end.
struct Task {
  std::string key;
  std::string scene;                 // scene JSON text
  std::filesystem::path output;      // record.h5 to write (through .part, sync, rename)
  std::filesystem::path checkpoint;  // written on SIGTERM and at the wall budget; resumed from where it exists and fits; empty: none
  double wall_budget_s = 8.0 * 3600.0;
  int attempt = 1;
  double step_scale = 1.0;  // dt factor, 0.5 after SOLVER_NUMERIC
  int threads = 1;          // of one large FDEM run by hand; a worker's slot is one core, so it is not on the pipe
};

// What `solve --json` prints (SCENES.md), and what a `done` report carries.
struct Summary {
  Verdict verdict = Verdict::censored;
  std::optional<double> time_to_failure;  // s
  std::string failure_rule;
  std::map<std::string, std::optional<double>> times;  // each criterion, s
  double peak_stress = 0.0;                            // Pa
  long long steps = 0;
  double dt = 0.0;  // s
  double energy_residual = 0.0;
  double cpu_s = 0.0;
  double wall_s = 0.0;
  std::map<std::string, double> stages;  // seconds by stage
  std::string kernel;                    // ISA path and precision
  std::string record_sha256;
};

// Child -> worker.
struct Report {
  enum class Kind { ready, progress, done, stopped, fault } kind = Kind::ready;
  std::string key;
  std::string build_id;        // ready
  long long step = 0;          // progress
  double time = 0.0;           // progress: simulated s
  double horizon = 0.0;        // progress: simulated s
  Summary summary;             // done
  std::optional<Error> error;  // fault
};

std::string to_line(const Task& task);  // ends with a newline
std::string to_line(const Report& report);
std::string to_json_text(const Summary& summary);  // one object, no newline
Result<Task> task_from_line(std::string_view line);
Result<Report> report_from_line(std::string_view line);

}  // namespace fracfarm
