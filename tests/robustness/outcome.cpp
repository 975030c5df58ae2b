#include "tests/robustness/outcome.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/record/check.hpp"
#include "common/scene/parse.hpp"
#include "solver/program/run_task.hpp"
#include "tests/robustness/accepted.hpp"
#include "tests/robustness/hostile_scene.hpp"

namespace fracfarm::robustness {
namespace {

constexpr double node_steps = 4e6;  // of one explicit run: about 100 ms; an implicit step costs a hundred of them

Outcome ended(End end, std::string why) {
  Outcome outcome;
  outcome.end = end, outcome.why = std::move(why);
  return outcome;
}
Outcome violation(std::string why) { return ended(End::violation, std::move(why)); }

// A refusal must say where, what and what would be right.
Outcome judge_refusal(const Problems& problems) {
  if (problems.empty()) return violation("refused without a problem");
  for (const Problem& p : problems)
    if (p.limit.empty() || (p.key.empty() && p.value.empty()))
      return violation(fmt::format("a problem without words: '{}' = '{}'", p.key, p.value));
  const Problem& first = problems.front();
  return ended(End::rejected, fmt::format("{} = {} (allowed: {}){}", first.key, first.value, first.limit,
                                          problems.size() > 1 ? fmt::format(" and {} more", problems.size() - 1) : ""));
}

// Evidence: the step, the time and what was wrong.
Outcome judge_error(const Error& error) {
  static const std::regex evidence("at step [0-9]+, [-+0-9.e]+ s");
  if (error.fault == Fault::bad_request) return ended(End::rejected, error.message);  // a mesh file that is not there
  if (error.fault != Fault::solver_numeric) return violation(fmt::format("{}: {}", fault_row(error.fault).name, error.message));
  if (!std::regex_search(error.message, evidence)) return violation("no step and time in the evidence: " + error.message);
  return ended(End::numeric, error.message);
}

std::string broken_text(const Scene& scene) {
  const std::string text = canonical_text(scene);
  const Parsed<Scene> again = parse_scene(text);
  if (!again) return "the canonical text is refused: " + problems_text(again.error());
  return *again == scene && canonical_text(*again) == text ? "" : "the canonical text is another scene";
}

std::string broken_record(const Scene& scene, const Trial& trial) {
  Task task;
  task.key = job_key(canonical_text(scene), build_info().build_id);
  task.output = trial.scratch / fmt::format("{}.h5", trial.index);
  task.wall_budget_s = 0.5 * trial.limit_s;
  const Result<TaskEnd> end = run_task(task, scene, Keeping::scratch, [](long long, double, double) {});
  if (!end) return fmt::format("{}: {}", fault_row(end.error().fault).name, end.error().message);
  std::string broken;
  for (const Check& check : check_record(task.output, {task.key}))
    if (!check.passed)
      broken +=
          fmt::format("{}{} = {:.3g} (limit {:.3g}) {}", broken.empty() ? "" : "; ", check.name, check.value, check.limit, check.detail);
  std::error_code ignored;
  std::filesystem::remove(task.output, ignored);
  return broken;
}

RunControl control_of(const Scene& scene, const Trial& trial) {
  RunControl control;
  const double nodes = scene.method == Method::fdem
                           ? 2.31 * scene.width * scene.height / (scene.fdem.element_size * scene.fdem.element_size)
                           : (scene.phase_field.cells_x + 1.0) * (scene.phase_field.cells_z + 1.0);
  const bool implicit = scene.method == Method::phase_field && scene.phase_field.integrator != Integrator::explicit_central;
  control.step_budget = std::max(implicit ? 10LL : 100LL, std::llround((implicit ? 0.01 : 1.0) * node_steps / nodes));
  control.wall_budget_s = 0.5 * trial.limit_s;
  return control;
}

// A mesh that the gate refused: the reason, and nothing else.
Outcome judge_rejection(const RunResult& result) {
  if (result.judgement.rule.empty()) return violation("rejected without a reason");
  if (result.series.rows() > 0 || result.judgement.time_to_failure) return violation("rejected, with a result");
  return ended(End::rejected, "mesh: " + result.judgement.rule);
}

Outcome judge_result(const Scene& scene, const RunResult& result, const Trial& trial) {
  if (scene.method == Method::fdem && result.judgement.verdict == Verdict::rejected) return judge_rejection(result);
  Outcome outcome = ended(result.judgement.verdict == Verdict::failed ? End::failed : End::censored, result.judgement.rule);
  if (const std::string broken = broken_rule(scene, result); !broken.empty()) outcome = violation(broken);
  outcome.steps = result.steps;
  const bool quasi_static = scene.phase_field.integrator == Integrator::quasi_static;
  outcome.ledger_share = outcome.end == End::violation || quasi_static ? 0.0 : ledger_share(result);
  // The program has no step budget, so only runs that ended by themselves are made again with their record.
  outcome.validated =
      trial.validate && outcome.end != End::violation && result.judgement.rule != "step_budget" && result.judgement.rule != "wall_clock";
  if (!outcome.validated) return outcome;
  if (const std::string broken = broken_record(scene, trial); !broken.empty()) return violation("the record: " + broken);
  return outcome;
}

Outcome solved(const std::string& text, const Trial& trial) {
  const Parsed<Scene> scene = parse_scene(text);
  if (!scene) return judge_refusal(scene.error());
  if (const std::string broken = broken_text(*scene); !broken.empty()) return violation(broken);
  scene_warnings(*scene);
  const Result<RunResult> result = solve(*scene, control_of(*scene, trial));
  return result ? judge_result(*scene, *result, trial) : judge_error(result.error());
}

}  // namespace

Outcome outcome_of_text(const std::string& text, const Trial& trial) {
  SystemClock clock;
  const double start = clock.monotonic_s();
  Outcome outcome;
  try {
    outcome = solved(text, trial);
  } catch (const std::exception& error) {
    outcome = violation(fmt::format("an exception left the door: {}", error.what()));
  }
  outcome.index = trial.index;
  outcome.seconds = clock.monotonic_s() - start;
  return outcome;
}

Outcome outcome_of(const Trial& trial) {
  const HostileScene scene = hostile_scene(trial.seed, trial.index, trial.method);
  Outcome outcome = outcome_of_text(scene.text, trial);
  outcome.twists = scene.twists;
  return outcome;
}

std::string to_line(const Outcome& o) {
  using nlohmann::json;
  const json line{{"index", o.index},     {"twists", o.twists}, {"end", static_cast<int>(o.end)}, {"why", o.why.substr(0, 1000)},
                  {"seconds", o.seconds}, {"steps", o.steps},   {"ledger_share", o.ledger_share}, {"validated", o.validated}};
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

Outcome from_line(const std::string& line) {
  const auto json = nlohmann::json::parse(line);
  return {.index = json.at("index"),
          .twists = json.at("twists"),
          .end = static_cast<End>(json.at("end").get<int>()),
          .why = json.at("why"),
          .seconds = json.at("seconds"),
          .steps = json.at("steps"),
          .ledger_share = json.at("ledger_share"),
          .validated = json.at("validated")};
}

}  // namespace fracfarm::robustness
