// Verbs that move jobs and workers: retry, hold, release, cancel, priority, drain. Each says what it did, or with --dry-run what it would
// do.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "coordinator/cli/change.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

struct Selection {
  std::vector<std::string> jobs;
  std::string fault, state, campaign, material, load, method;
  std::int64_t count = 0;
  bool dry_run = false;

  void add_to(Command& app) {
    app.add_option("JOB", jobs, "ids, or the first characters of keys");
    app.add_option("--class", fault, "those whose last try ended in this fault, as SOLVER_CRASH");
    app.add_option("--state", state, "those in this state");
    app.add_option("--campaign", campaign, "those of the campaign of this name");
    app.add_option("--material", material, "those of this material");
    app.add_option("--load", load, "those of this load");
    app.add_option("--method", method, "those of this method");
    app.add_option("--count", count, "at most so many").positive();
    app.add_flag("--dry-run", dry_run, "say what would change, change nothing");
  }
  json arguments() const {
    json it{{"jobs", jobs}, {"dry_run", dry_run}};
    for (const auto& [name, value] : {std::pair{"class", &fault},
                                      {"state", &state},
                                      {"campaign", &campaign},
                                      {"material", &material},
                                      {"load", &load},
                                      {"method", &method}})
      if (!value->empty()) it[name] = *value;
    if (count > 0) it["count"] = count;
    return it;
  }
};

}  // namespace

int run_retry(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  Command app{"Makes jobs ready again, at once and with every budget anew: quarantined, cancelled, held or waiting ones.",
              "fracfarm retry"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "retry", selection.arguments(), {"made ready:", " job", "s"});
}

int run_cancel(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  Command app{"Takes jobs out that are not done; running ones are stopped. fracfarm retry brings them back.", "fracfarm cancel"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "cancel", selection.arguments(), {"cancelled:", " job", "s"});
}

int run_hold(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  Command app{"Keeps jobs that wait from being handed out; fracfarm release lets them go.", "fracfarm hold"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "hold", selection.arguments(), {"held:", " job", "s"});
}

int run_release(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  Command app{"Makes held jobs ready again.", "fracfarm release"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "release", selection.arguments(), {"released:", " job", "s"});
}

int run_priority(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  int value = 0;
  Command app{"Which jobs come first: those of higher priority; 0 is usual.", "fracfarm priority"};
  add_farm_options(app, options);
  app.add_option("--to", value, "from -1000 to 1000").required().in_range(-1000, 1000);
  selection.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  json arguments = selection.arguments();
  arguments["priority"] = value;
  return change(options, "priority", arguments, {"changed:", " job", "s"});
}

int run_drain(int argc, char** argv) {
  FarmOptions options;
  std::vector<std::string> workers;
  bool dry_run = false;
  Command app{"Workers finish what they hold, take no more and end; without a name, all of them. Started again they work again.",
              "fracfarm drain"};
  add_farm_options(app, options);
  app.add_option("WORKER", workers, "names of workers or nodes, as fracfarm status prints them");
  app.add_flag("--dry-run", dry_run, "say who would be drained, change nothing");
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "drain", {{"workers", workers}, {"dry_run", dry_run}}, {"drained:", " worker", "s"});
}

}  // namespace fracfarm::cli
