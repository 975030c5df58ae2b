#include "tests/system/mishap.hpp"

#include <signal.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

namespace fracfarm::bench {
namespace {

std::filesystem::path token_of(const FarmBench& farm) { return farm.folder() / "token"; }

// True where it has ended well; one that ended badly is started again.
bool ended_well(std::optional<Process>& it, const std::function<Process()>& again) {
  if (it->running()) return false;
  if (it->wait() == 0) return true;
  it.reset();
  it.emplace(again());
  return false;
}

}  // namespace

std::map<std::string, std::string> environment_of(const FarmBench& farm, const Mishap& mishap) {
  std::ofstream(token_of(farm)) << "once";
  return {{"LD_PRELOAD", FRACFARM_KILL_SHIM},
          {"FRACFARM_KILL_PROGRAM", mishap.program},
          {"FRACFARM_KILL_AT", std::to_string(mishap.call)},
          {"FRACFARM_KILL_TROUBLE", mishap.trouble},
          {"FRACFARM_KILL_FILES", mishap.files},
          {"FRACFARM_KILL_TOKEN", token_of(farm).string()}};
}

bool happened(const FarmBench& farm) { return !std::filesystem::exists(token_of(farm)); }

void submit_drills(FarmBench& farm, int jobs, double seconds) {
  const auto file = farm.folder() / "drills.toml";
  std::ofstream(file) << "name = \"drills\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-" << jobs
                      << "\" }\nset = { \"drill.act\" = \"sleep\", \"drill.seconds\" = " << seconds << " }\n";
  REQUIRE(farm.verb({"submit", file.string()}).status == 0);
}

bool drills_with_a_mishap(int jobs, const Mishap& mishap) {
  FarmBench farm;
  submit_drills(farm, jobs);
  const auto environment = environment_of(farm, mishap);
  std::optional<Process> coordinator(farm.start({"coordinator", "--until-done", "--lease-timeout", "2"}, environment));
  std::optional<Process> worker(farm.start({"worker", "--slots", "1", "--once"}, environment));
  const auto served = [&] {
    if (ended_well(coordinator, [&] { return farm.coordinator({"--until-done", "--lease-timeout", "2"}); })) return true;
    (void)ended_well(worker, [&] { return farm.worker({"--slots", "1", "--once"}); });
    return false;
  };
  REQUIRE(wait_until(served));
  worker->signal(SIGTERM);  // one that died as it ended was started again, and nobody is there for it
  worker->wait();
  farm.check_all_done(jobs);
  return happened(farm);
}

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

}  // namespace fracfarm::bench
