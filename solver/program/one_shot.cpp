#include "solver/program/one_shot.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "solver/program/run_task.hpp"
#include "solver/program/scene_file.hpp"

namespace fracfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr double patience_s = 2.0;  // runs that are shorter show no progress

void print_json(const Json& json) { fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace)); }

// A run that diverged still answers in the shape of a summary, with the evidence beside it.
int report_error(const Error& error, int status, const OneShot& options) {
  const std::string_view fault = fault_row(error.fault).name;
  if (options.json && error.fault == Fault::solver_numeric) {
    Summary summary;
    summary.verdict = Verdict::diverged;
    summary.failure_rule = "diverged";
    Json json = Json::parse(to_json_text(summary));
    json["fault"] = fault;
    json["message"] = error.message;
    print_json(json);
  } else if (options.json) {
    print_json({{"schema", "fracfarm.error/1"}, {"fault", fault}, {"message", error.message}});
  } else {
    fmt::print(stderr, "{} {} ({})\n", ink("error:", Ink::red, stderr), error.message, fault);
  }
  return status;
}

std::string time_text(const std::optional<double>& time) { return time ? engineering(*time, "s") : "none"; }

void print_summary(const Summary& s, const OneShot& options) {
  if (options.json) return print_json(Json::parse(to_json_text(s)));
  std::vector<std::vector<std::string>> rows{{"quantity", "value"}};
  rows.push_back({"verdict", fmt::format("{} by {}", name_of(s.verdict), s.failure_rule)});
  rows.push_back({"time to failure", time_text(s.time_to_failure)});
  for (const auto& [rule, time] : s.times) rows.push_back({"  " + rule, time_text(time)});
  rows.push_back({"peak mean stress", engineering(s.peak_stress, "Pa")});
  rows.push_back({"steps", fmt::format("{} of {}", s.steps, engineering(s.dt, "s"))});
  rows.push_back({"energy residual", fmt::format("{:.3f} %", 100.0 * s.energy_residual)});
  rows.push_back({"time", fmt::format("{} ({} CPU), {}", duration_text(s.wall_s), duration_text(s.cpu_s), s.kernel)});
  rows.push_back({"record", options.output.string()});
  fmt::print("{}", table_text(rows));
}

// No mesh could be made of the scene: there is no record.
int report_rejected(const Summary& summary, const OneShot& options) {
  if (options.json)
    print_json(Json::parse(to_json_text(summary)));
  else
    fmt::print(stderr, "{} the scene is rejected: {}\n", ink("error:", Ink::red, stderr), summary.failure_rule);
  return exit_bad_input;
}

class ProgressReport {
 public:
  explicit ProgressReport(bool quiet) : quiet_(quiet) {}

  void operator()(long long step, double time, double horizon) {
    const double elapsed = clock_.monotonic_s() - start_s_;
    if (quiet_ || elapsed < patience_s || time <= 0.0) return;
    if (first_time_ < 0.0) first_time_ = time, first_s_ = elapsed;
    const double speed = elapsed > first_s_ ? (time - first_time_) / (elapsed - first_s_) : 0.0;
    line_.show(fmt::format("step {}  {} of at most {}  {}", step, engineering(time, "s"), engineering(horizon, "s"),
                           speed > 0.0 ? "at most " + duration_text((horizon - time) / speed) + " left" : std::string()));
  }

 private:
  bool quiet_;
  SystemClock clock_;
  double start_s_ = clock_.monotonic_s();
  double first_time_ = -1.0, first_s_ = 0.0;  // a resumed run does not start at 0
  ProgressLine line_;
};

}  // namespace

int solve_one(const OneShot& options) {
  const Result<std::string> text = scene_text(options.scene);
  if (!text) return report_error(text.error(), exit_bad_input, options);
  const Parsed<Scene> scene = parse_scene(*text);
  if (!scene) return report_problems(scene.error(), options.scene, options.json);
  if (!options.quiet)
    for (const std::string& warning : scene_warnings(*scene)) fmt::print(stderr, "{} {}\n", ink("warning:", Ink::yellow, stderr), warning);
  Task task;
  task.key = job_key(canonical_text(*scene), build_info().build_id);
  task.output = options.output;
  task.checkpoint = options.checkpoint;
  task.wall_budget_s = options.wall_budget_s;
  task.threads = options.threads;
  Result<TaskEnd> end = [&] {
    ProgressReport progress(options.quiet);
    return run_task(task, *scene, Keeping::durable, std::ref(progress));
  }();
  if (!end) return report_error(end.error(), exit_failed, options);
  if (end->stopped) {
    fmt::print(stderr, "stopped by a signal{}\n",
               options.checkpoint.empty() ? "; no checkpoint was asked for" : "; run again to go on from " + options.checkpoint.string());
    return exit_stopped;
  }
  if (end->summary.verdict == Verdict::rejected) return report_rejected(end->summary, options);
  print_summary(end->summary, options);
  return exit_ok;
}

}  // namespace fracfarm
