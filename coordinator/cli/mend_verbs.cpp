// Verbs that change what a farm will do: retry, cancel, drain. Each says what it did, or with --dry-run what it would do.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

std::string change_text(const json& answer, std::string_view did, std::string_view what) {
  const bool dry = answer.value("dry_run", false);
  const std::uint64_t n = answer.value("changed", std::uint64_t{0});
  std::string text = fmt::format("{}{} {}{}{}\n", dry ? "would be " : "", did, n, what, n == 1 ? "" : "s");
  for (const json& it : answer["refused"]) text += fmt::format("job {}: {}\n", it.value("job", 0), it.value("why", ""));
  return text;
}

int change(const FarmOptions& options, const std::string& verb, const json& arguments, std::string_view did, std::string_view what) {
  return guarded(options, [&] {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), options.json);
    const Answered answer = ask_and_report(*link, verb, arguments, options.json);
    if (answer.usable) fmt::print("{}", change_text(json::parse(answer.body), did, what));
    return answer.exit_code;
  });
}

struct Selection {
  std::vector<std::string> jobs;
  std::string fault, state, campaign;
  bool dry_run = false;

  void add_to(CLI::App& app) {
    app.add_option("JOB", jobs, "ids, or the first characters of keys");
    app.add_option("--class", fault, "those whose last try ended in this fault, as SOLVER_CRASH");
    app.add_option("--state", state, "those in this state");
    app.add_option("--campaign", campaign, "those of the campaign of this name");
    app.add_flag("--dry-run", dry_run, "say what would change, change nothing");
  }
  json arguments() const {
    json it{{"jobs", jobs}, {"dry_run", dry_run}};
    if (!fault.empty()) it["class"] = fault;
    if (!state.empty()) it["state"] = state;
    if (!campaign.empty()) it["campaign"] = campaign;
    return it;
  }
};

}  // namespace

int run_retry(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  CLI::App app{"Makes jobs ready again, at once and with every budget anew: quarantined, cancelled, held or waiting ones.",
               "fracfarm retry"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = parse(app, argc, argv)) return *status;
  return change(options, "retry", selection.arguments(), "made ready:", " job");
}

int run_cancel(int argc, char** argv) {
  FarmOptions options;
  Selection selection;
  CLI::App app{"Takes jobs out that are not done; running ones are stopped. fracfarm retry brings them back.", "fracfarm cancel"};
  add_farm_options(app, options);
  selection.add_to(app);
  if (const auto status = parse(app, argc, argv)) return *status;
  return change(options, "cancel", selection.arguments(), "cancelled:", " job");
}

int run_drain(int argc, char** argv) {
  FarmOptions options;
  std::vector<std::string> workers;
  bool dry_run = false;
  CLI::App app{"Workers finish what they hold, take no more and end; without a name, all of them. Started again they work again.",
               "fracfarm drain"};
  add_farm_options(app, options);
  app.add_option("WORKER", workers, "names of workers or nodes, as fracfarm status prints them");
  app.add_flag("--dry-run", dry_run, "say who would be drained, change nothing");
  if (const auto status = parse(app, argc, argv)) return *status;
  return change(options, "drain", {{"workers", workers}, {"dry_run", dry_run}}, "drained:", " worker");
}

}  // namespace fracfarm::cli
