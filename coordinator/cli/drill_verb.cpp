// fracfarm drill: does this site's farm see what it should? Every act of the drills goes wrong once on a farm of its own, with daemons of
// its own, and must be seen as the fault that it is, tried again, and done.
#include <fmt/format.h>
#include <stdlib.h>

#include <array>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/fault.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/local_daemons.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/submission.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

struct Rehearsed {
  std::string_view act;
  std::string_view fault;  // that it must be seen as; empty: none
  std::string_view what;
};
constexpr std::array<Rehearsed, 9> acts{{
    {"sleep", "", "ends well"},
    {"crash", "SOLVER_CRASH", "the solver ends by a signal"},
    {"hang", "SOLVER_CRASH", "the solver says nothing any more"},
    {"leak", "OUT_OF_MEMORY", "memory until the limit"},
    {"truncated", "OUTPUT_BAD", "half a record"},
    {"bit_flipped", "OUTPUT_BAD", "a record with one bit changed"},
    {"wrong_job", "OUTPUT_BAD", "a sound record of another job"},
    {"nan", "OUTPUT_BAD", "a record with not-a-number"},
    {"ignore_term", "SOLVER_CRASH", "works past its wall clock and ignores SIGTERM"},
}};
constexpr double patience_s = 60.0;  // for one act

struct DrillOptions {
  std::filesystem::path in = ".";
  bool keep = false, json = false;
};

struct Seen {
  const Rehearsed& act;
  std::string fault, message;
  bool done = false;
  double seconds = 0.0;
  bool as_expected() const { return done && fault == act.fault; }
};

// A farm folder that is removed at the end, with its two daemons.
class DrillFarm {
 public:
  DrillFarm(std::filesystem::path folder, bool keep) : folder_(std::move(folder)), keep_(keep) {}
  ~DrillFarm() {
    if (worker_) worker_->stop(10.0);
    if (coordinator_) coordinator_->stop(10.0);
    std::error_code ignored;
    if (!keep_) std::filesystem::remove_all(folder_, ignored);
  }
  DrillFarm(const DrillFarm&) = delete;
  DrillFarm& operator=(const DrillFarm&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

  Result<FarmLink> start() {
    const std::string farm = folder_.string();
    coordinator_ = daemon("fracfarm-coordinator", {"--farm", farm});
    worker_ = daemon("fracfarm-worker", {"--farm", farm, "--slots", "1", "--memory-limit", "2G", "--hang-after", "2", "--grace", "1",
                                         "--budget-grace", "0.5"});
    if (const Result<void> started = coordinator_->start(); !started) return tl::unexpected(started.error());
    SystemClock clock;
    for (const double last_s = clock.monotonic_s() + 20.0; clock.monotonic_s() < last_s;) {
      if (!coordinator_->running()) break;
      if (std::filesystem::exists(folder_ / "endpoint.json")) {
        if (const Result<void> started = worker_->start(); !started) return tl::unexpected(started.error());
        return FarmLink::open(folder_);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return fail(Fault::node_lost, fmt::format("the coordinator did not begin to serve; see {}", coordinator_->output().string()));
  }
  bool alive() { return coordinator_->running() && worker_->running(); }

 private:
  std::unique_ptr<LocalDaemon> daemon(const std::string& program, std::vector<std::string> arguments) {
    return std::make_unique<LocalDaemon>(program, std::move(arguments), folder_ / "log" / (program + ".out"));
  }
  std::filesystem::path folder_;
  bool keep_;
  std::unique_ptr<LocalDaemon> coordinator_, worker_;
};

// The act goes wrong in the first attempt and ends well in the second. Only the one that works past its wall clock has to reach it; on a
// busy machine a leak takes its seconds.
std::string campaign_of(const Rehearsed& act) {
  const int wall_clock_s = act.act == "ignore_term" ? 3 : 30;
  return json{{"name", fmt::format("drill-{}", act.act)},
              {"seed", 1},
              {"jobs", json::array({{{"method", "drill"},
                                     {"patterns", {{"orthogonal", "1"}}},
                                     {"set", {{"drill.act", act.act}, {"drill.attempts", 1}, {"drill.seconds", 0.1}}}}})},
              {"budget", {{"wall_clock", wall_clock_s}, {"attempts", 3}}}}
      .dump();
}

Result<json> ask(FarmLink& link, const std::string& verb, const json& arguments) {
  const Result<wire::Answer> answer = link.ask(verb, arguments);
  if (!answer) return tl::unexpected(answer.error());
  json body = json::parse(answer->body, nullptr, false);
  if (answer->exit_code != exit_ok || !body.is_object()) return fail(Fault::bad_request, fmt::format("{}: {}", verb, answer->body));
  return body;
}

// `job`: ids count from 1 in the order of submitting.
Result<Seen> rehearse(DrillFarm& farm, FarmLink& link, const Rehearsed& act, int job) {
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  if (const auto submitted = ask(link, "submit", {{"campaign", campaign_of(act)}}); !submitted) return tl::unexpected(submitted.error());
  Seen seen{act, {}, {}, false, 0.0};
  while (clock.monotonic_s() - began_s < patience_s && !seen.done) {
    if (!farm.alive()) return fail(Fault::node_lost, fmt::format("a daemon ended; see {}", (farm.folder() / "log").string()));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Result<json> status = ask(link, "status", json::object());
    if (!status) return tl::unexpected(status.error());
    if (status->value("total", 0) < job) continue;  // not made yet
    const Result<json> told = ask(link, "explain", {{"job", std::to_string(job)}});
    if (!told) return tl::unexpected(told.error());
    seen.done = told->value("state", "") == "done";
    if ((*told)["history"].empty()) continue;
    seen.fault = (*told)["history"][0].value("fault", "");
    seen.message = (*told)["history"][0].value("message", "");
    if (told->value("state", "") == "quarantined") break;
  }
  seen.seconds = clock.monotonic_s() - began_s;
  return seen;
}

int tell(const std::vector<Seen>& all, const DrillOptions& options) {
  bool good = true;
  json rows_json = json::array();
  std::vector<std::vector<std::string>> rows{{"act", "what goes wrong", "expected", "seen", "then", "time", ""}};
  for (const Seen& seen : all) {
    good = good && seen.as_expected();
    const auto word = [](std::string_view fault) { return fault.empty() ? std::string("none") : std::string(fault); };
    rows.push_back({std::string(seen.act.act), std::string(seen.act.what), word(seen.act.fault), word(seen.fault),
                    seen.done ? "done" : "not done", duration_text(seen.seconds),
                    seen.as_expected() ? ink("as expected", Ink::green, stdout) : ink("NOT AS EXPECTED", Ink::red, stdout)});
    rows_json.push_back({{"act", seen.act.act},
                         {"expected", word(seen.act.fault)},
                         {"seen", word(seen.fault)},
                         {"message", seen.message},
                         {"done", seen.done},
                         {"as_expected", seen.as_expected()},
                         {"seconds", seen.seconds}});
  }
  if (options.json)
    fmt::print("{}\n", json{{"schema", "fracfarm.drill/1"}, {"as_expected", good}, {"acts", rows_json}}.dump(
                           2, ' ', false, json::error_handler_t::replace));
  else
    fmt::print("{}", table_text(rows));
  return good ? exit_ok : exit_failed;
}

int drill(const DrillOptions& options) {
  std::string name = (std::filesystem::absolute(options.in) / "fracfarm-drill-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    return report_error({Fault::bad_request, fmt::format("cannot make a folder in {}; name another with --in", options.in.string())},
                        options.json);
  DrillFarm farm(name, options.keep);
  std::filesystem::create_directories(farm.folder() / "log");
  Result<FarmLink> link = farm.start();
  if (!link) return report_unreachable(link.error(), options.json);
  ProgressLine line;
  std::vector<Seen> all;
  for (const Rehearsed& act : acts) {
    line.show(fmt::format("drill {} of {}: {} ({})", all.size() + 1, acts.size(), act.act, act.what));
    Result<Seen> seen = rehearse(farm, *link, act, static_cast<int>(all.size()) + 1);
    if (!seen) return report_error(seen.error(), options.json);
    all.push_back(std::move(*seen));
  }
  line.finish(options.keep ? fmt::format("drilled; the farm stays in {}", farm.folder().string()) : "drilled");
  return tell(all, options);
}

}  // namespace

int run_drill(int argc, char** argv) {
  DrillOptions options;
  Command app{
      "Rehearses on this site: a farm of its own, with daemons of its own, where a solver crashes, hangs, leaks, writes bad records and\n"
      "ignores SIGTERM. Each must be seen as the fault that it is, and the job done in the end. About half a minute.\n"
      "Exit status: 0 all as expected, 1 not.",
      "fracfarm drill"};
  app.add_option("--in", options.in, "folder in which the farm is made, and removed again: on the file system to rehearse on")
      .with_default_shown();
  app.add_flag("--keep", options.keep, "leave the farm's folder, with its logs");
  app.add_flag("--json", options.json, "one JSON object");
  if (const auto status = app.parse(argc, argv)) return *status;
  FarmOptions guard;
  guard.json = options.json;
  return guarded(guard, [&] { return drill(options); });
}

}  // namespace fracfarm::cli
