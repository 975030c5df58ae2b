// Verbs that look at a farm and change nothing: status, jobs, explain.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/status_text.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

// Asks and prints; `text` makes the answer readable.
template <class Text>
int look(const FarmOptions& options, const std::string& verb, const json& arguments, const Text& text) {
  Result<FarmLink> link = FarmLink::open(options.farm);
  if (!link) return report_unreachable(link.error(), options.json);
  const Answered answer = ask_and_report(*link, verb, arguments, options.json);
  if (answer.usable) fmt::print("{}", text(json::parse(answer.body)));
  return answer.exit_code;
}

// Until everything is settled: a page that is drawn again on a terminal, a line a minute without one.
int watch(const FarmOptions& options) {
  const bool terminal = is_terminal(stdout);
  ProgressLine line(stdout);
  for (;;) {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), options.json);
    const Result<wire::Answer> answer = link->ask("status", json::object());
    if (!answer) return report_unreachable(answer.error(), options.json);
    const json status = json::parse(answer->body);
    const bool settled = status.value("settled", false);
    if (options.json)
      fmt::print("{}\n", status.dump());
    else if (terminal)
      fmt::print("\x1b[H\x1b[2J{}", status_text(status, stdout));
    else if (settled)
      line.finish(progress_text(status));
    else
      line.show(progress_text(status));
    std::fflush(stdout);
    if (settled) return exit_ok;
    link = fail(Fault::planned_stop, "");  // lets go of the ledger
    std::this_thread::sleep_for(std::chrono::seconds(2));
  }
}

}  // namespace

int run_status(int argc, char** argv) {
  FarmOptions options;
  bool again = false;
  Command app{"How a farm stands: counts by state, material and load, rate, time left, faults, workers.", "fracfarm status"};
  add_farm_options(app, options);
  app.add_flag("--watch", again, "again and again until nothing is left to do");
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] {
    if (again) return watch(options);
    return look(options, "status", json::object(), [](const json& status) { return status_text(status, stdout); });
  });
}

int run_jobs(int argc, char** argv) {
  FarmOptions options;
  std::string state, material, load, fault, campaign;
  std::int64_t limit = 50, after = 0;
  Command app{"Jobs as a table: state, verdict, time-to-failure, peak stress.", "fracfarm jobs"};
  add_farm_options(app, options);
  app.add_option("--state", state, "held, ready, leased, done, retry_wait, quarantined or cancelled");
  app.add_option("--material", material, "of this material");
  app.add_option("--load", load, "uniaxial or biaxial");
  app.add_option("--class", fault, "whose last try ended in this fault, as SOLVER_CRASH");
  app.add_option("--campaign", campaign, "of the campaign of this name");
  app.add_option("--after", after, "with ids above this").not_negative();
  app.add_option("--limit", limit, "rows at most").in_range(1, 10000).with_default_shown();
  if (const auto status = app.parse(argc, argv)) return *status;
  json arguments{{"limit", limit}, {"after", after}};
  for (const auto& [name, value] :
       {std::pair{"state", &state}, {"material", &material}, {"load", &load}, {"class", &fault}, {"campaign", &campaign}})
    if (!value->empty()) arguments[name] = *value;
  return guarded(options, [&] {
    return look(options, "jobs", arguments, [](const json& answer) {
      if (answer["jobs"].empty()) return std::string("no such jobs\n");
      const std::string more = answer.value("more", false)
                                   ? fmt::format("... more: --after {} or a larger --limit\n", answer["jobs"].back().value("id", 0))
                                   : "";
      return jobs_text(answer) + more;
    });
  });
}

int run_explain(int argc, char** argv) {
  FarmOptions options;
  std::string job, worker;
  bool scene = false;
  Command app{"Everything that happened to one job (or: worker NAME), why it is where it is, and what to do.", "fracfarm explain"};
  add_farm_options(app, options);
  app.add_option("JOB", job, "id, or the first characters of its key; or the word worker").required();
  app.add_option("NAME", worker, "after the word worker: its name or its node's, as fracfarm status prints them");
  app.add_flag("--scene", scene, "print its scene instead, to solve it by hand: fracfarm solve");
  if (const auto status = app.parse(argc, argv)) return *status;
  if (job == "worker" && !worker.empty())
    return guarded(options, [&] {
      return look(options, "worker", {{"worker", worker}}, [](const json& answer) { return worker_text(answer, stdout); });
    });
  return guarded(options, [&] {
    return look(options, "explain", {{"job", job}, {"scene", scene}},
                [&](const json& answer) { return scene ? answer.value("scene", "") + "\n" : explain_text(answer, stdout); });
  });
}

}  // namespace fracfarm::cli
