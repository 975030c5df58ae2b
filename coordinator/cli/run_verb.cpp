// fracfarm run: a campaign from file to finished records on this machine. Submits, starts what is not running, waits, ends what it started.
#include <fmt/format.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/local_daemons.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/status_text.hpp"
#include "coordinator/cli/submission.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

constexpr double poll_s = 0.25;
constexpr double worker_grace_s = 60.0;  // to write checkpoints and give jobs back
constexpr double coordinator_grace_s = 10.0;
constexpr int most_restarts = 5;  // of a daemon, with no job done between

std::atomic<bool> stop_asked{false};
void on_signal(int) { stop_asked = true; }

struct RunOptions {
  FarmOptions farm;
  std::filesystem::path campaign;
  int workers = 0;
};

// The daemons of this run; either may have been there before, and is then left alone.
struct Daemons {
  std::unique_ptr<LocalDaemon> coordinator, worker;
  int restarts = 0;
  std::uint64_t done_at_restart = 0;

  // Worker first: it gives its jobs back to a coordinator that still listens.
  void stop() {
    if (worker) worker->stop(worker_grace_s);
    if (coordinator) coordinator->stop(coordinator_grace_s);
  }
};

Result<FarmLink> link_to_coordinator(const RunOptions& options, Daemons& daemons) {
  {
    Result<FarmLink> link = FarmLink::open(options.farm.farm);
    if (!link || link->served()) return link;
  }  // lets go of the ledger
  daemons.coordinator =
      std::make_unique<LocalDaemon>("fracfarm-coordinator", std::vector<std::string>{"--farm", options.farm.farm.string()},
                                    options.farm.farm / "log" / "coordinator.out");
  if (const Result<void> started = daemons.coordinator->start(); !started) return tl::unexpected(started.error());
  SystemClock clock;
  for (const double last_s = clock.monotonic_s() + 20.0; clock.monotonic_s() < last_s;) {
    if (!daemons.coordinator->running())
      return fail(Fault::node_lost, fmt::format("the coordinator ended with status {}; see {}",
                                                daemons.coordinator->exit_status().value_or(0), daemons.coordinator->output().string()));
    if (last_holder({options.farm.farm}) == holder_coordinator) {
      Result<FarmLink> link = FarmLink::open(options.farm.farm);
      if (!link || link->served()) return link;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return fail(Fault::node_lost, "the coordinator did not begin to serve");
}

Result<void> start_worker(const RunOptions& options, Daemons& daemons) {
  const std::vector<std::string> arguments{"--farm", options.farm.farm.string(), "--slots", std::to_string(options.workers), "--once"};
  daemons.worker = std::make_unique<LocalDaemon>("fracfarm-worker", arguments, options.farm.farm / "log" / "worker.out");
  return daemons.worker->start();
}

Result<void> restart_dead(const json& status, Daemons& daemons) {
  const std::uint64_t done = status["counts"].value("done", std::uint64_t{0});
  if (done > daemons.done_at_restart) daemons.restarts = 0;
  daemons.done_at_restart = done;
  for (LocalDaemon* daemon : {daemons.coordinator.get(), daemons.worker.get()}) {
    if (!daemon || daemon->running()) continue;
    if (++daemons.restarts > most_restarts)
      return fail(Fault::node_lost, fmt::format("{} ended with status {} again and again; see {}", daemon->program(),
                                                daemon->exit_status().value_or(0), daemon->output().string()));
    fmt::print(stderr, "{} {} ended with status {}: starting it again\n", ink("warning:", Ink::yellow, stderr), daemon->program(),
               daemon->exit_status().value_or(0));
    if (const Result<void> started = daemon->start(); !started) return started;
  }
  return {};
}

// Whatever is ready is of a paused class.
bool all_paused(const json& status) {
  std::uint64_t ready = 0, of_paused = 0;
  for (const json& it : status["classes"]) {
    const std::uint64_t n = it["counts"].value("ready", std::uint64_t{0});
    ready += n;
    for (const json& paused : status["paused"])
      if (paused["method"] == it["method"] && paused["material"] == it["material"] && paused["load"] == it["load"]) of_paused += n;
  }
  return ready > 0 && ready == of_paused;
}

// Every worker stopped by too many fast faults and nothing running: nothing will ever happen.
bool stuck(const json& status) {
  if (status["counts"].value("leased", 0) == 0 && status["counts"].value("retry_wait", 0) == 0 && all_paused(status)) return true;
  if (status["workers"].empty() || status["counts"].value("leased", 0) > 0) return false;
  for (const json& worker : status["workers"])
    if (worker.value("state", "") != "stopped") return false;
  return true;
}

// Waits until nothing is left; gives the last status, printed for nobody yet.
Result<json> wait_until_done(FarmLink& link, Daemons& daemons) {
  ProgressLine line;
  json status;
  while (!stop_asked) {
    const Result<wire::Answer> answer = link.ask("status", json::object());
    if (!answer && daemons.coordinator && !daemons.coordinator->running()) {
      if (const Result<void> again = restart_dead(status.is_null() ? json{{"counts", json::object()}} : status, daemons); !again)
        return tl::unexpected(again.error());
      continue;
    }
    if (!answer) return tl::unexpected(answer.error());
    status = json::parse(answer->body);
    line.show(progress_text(status));
    if (status.value("settled", false)) break;
    if (stuck(status))
      return fail(Fault::node_lost, all_paused(status)
                                        ? "what is left is paused: fracfarm status says why, fracfarm resume goes on"
                                        : "every worker has had too many fast faults in a row and gets no more work: see fracfarm "
                                          "status and fracfarm failures");
    if (const Result<void> alive = restart_dead(status, daemons); !alive) return tl::unexpected(alive.error());
    std::this_thread::sleep_for(std::chrono::duration<double>(poll_s));
  }
  if (!status.is_null()) line.finish(progress_text(status));
  return status;
}

int finish(const RunOptions& options, const json& status, double elapsed_s) {
  const bool settled = status.is_object() && status.value("settled", false);
  const std::uint64_t quarantined = settled ? status["counts"].value("quarantined", std::uint64_t{0}) : 0;
  const int exit_code = !settled ? exit_stopped : quarantined ? exit_quarantined : exit_ok;
  if (options.farm.json) {
    fmt::print("{}\n", json{{"schema", "fracfarm.run/1"}, {"exit_code", exit_code}, {"elapsed_s", elapsed_s}, {"status", status}}.dump(2));
    return exit_code;
  }
  if (!settled) return fmt::print("stopped after {}; run it again to go on where it was\n", duration_text(elapsed_s)), exit_code;
  fmt::print("{}\nfinished in {}; records lie in the store of {}\n", status_text(status, stdout), duration_text(elapsed_s),
             options.farm.farm.string());
  return exit_code;
}

int run_campaign(const RunOptions& options) {
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  const Parsed<Campaign> campaign = load_campaign(options.campaign);
  if (!campaign) return report_problems(campaign.error(), options.campaign.string(), options.farm.json);
  {
    Result<FarmLink> link = FarmLink::open(options.farm.farm, true);
    if (!link) return report_unreachable(link.error(), options.farm.json);
    const Answered answer = submit(*link, *campaign, options.farm.json);
    if (!answer.usable) return answer.exit_code;
    if (!options.farm.json) fmt::print(stderr, "{}", submitted_text(json::parse(answer.body)));
  }
  std::error_code error;
  std::filesystem::create_directories(options.farm.farm / "log", error);
  Daemons daemons;
  const auto outcome = [&]() -> Result<json> {
    Result<FarmLink> link = link_to_coordinator(options, daemons);
    if (!link) return tl::unexpected(link.error());
    const Result<wire::Answer> first = link->ask("status", json::object());
    if (!first) return tl::unexpected(first.error());
    const json status = json::parse(first->body);
    if (status.value("settled", false)) return status;
    if (status["workers"].empty())
      if (const Result<void> started = start_worker(options, daemons); !started) return tl::unexpected(started.error());
    return wait_until_done(*link, daemons);
  }();
  if (stop_asked && !options.farm.json) fmt::print(stderr, "stopping: running jobs are checkpointed and given back\n");
  daemons.stop();
  if (!outcome) return report_error(outcome.error(), options.farm.json);
  return finish(options, *outcome, clock.monotonic_s() - began_s);
}

}  // namespace

int run_run(int argc, char** argv) {
  RunOptions options;
  options.workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  Command app{
      "Runs a campaign on this machine to its end: submits it, starts a coordinator and workers where none run, waits, ends what it "
      "started.\n"
      "Ctrl-C stops it in order; after that, or after any crash, run it again: it goes on where it was.\n"
      "Exit status: 0 all done, 5 some jobs quarantined, 3 stopped.",
      "fracfarm run"};
  app.add_option("CAMPAIGN", options.campaign, "campaign file, TOML or JSON").required();
  app.add_option("--workers,--slots", options.workers, "jobs solved at once; default: cores").in_range(1, 4096);
  add_farm_options(app, options.farm);
  if (const auto status = app.parse(argc, argv)) return *status;
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  return guarded(options.farm, [&] { return run_campaign(options); });
}

}  // namespace fracfarm::cli
