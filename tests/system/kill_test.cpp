// SIGKILL and SIGTERM at inconvenient moments: nothing that was finished is lost, nothing that was finished is done again.
#include <signal.h>

#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

namespace {

// Attempts of the jobs that are done now: none of them may ever be tried again.
std::map<int, int> attempts_of_done(FarmBench& farm) {
  std::map<int, int> attempts;
  for (const auto& job : farm.jobs())
    if (job["state"] == "done") attempts[job["id"]] = job["attempts"];
  return attempts;
}

void check_not_repeated(FarmBench& farm, const std::map<int, int>& before) {
  const auto after = attempts_of_done(farm);
  for (const auto& [job, attempts] : before) CHECK(after.at(job) == attempts);
}

}  // namespace

TEST_CASE("killing the coordinator again and again repeats no job while the workers live") {
  FarmBench farm;
  constexpr int jobs = 60;
  farm.submit({.patterns = jobs, .set = R"("phase_field.cells" = [79, 79])"});
  Process one = farm.worker({"--slots", "1", "--once"});
  Process two = farm.worker({"--slots", "1", "--once"});
  RandomStream random(11, 1, 1);
  for (int kill = 0; kill < 6; ++kill) {
    Process coordinator = farm.coordinator();
    sleep_s(random.uniform(0.2, 0.9));
    coordinator.signal(SIGKILL);
    CHECK(coordinator.wait() == 128 + SIGKILL);
    sleep_s(random.uniform(0.0, 0.3));
  }
  Process coordinator = farm.coordinator({"--until-done"});
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(jobs);
  for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
}

TEST_CASE("killing a worker leaves no solver behind and repeats only what it had not finished") {
  FarmBench farm;
  constexpr int jobs = 60;
  farm.submit({.patterns = jobs, .set = R"("phase_field.cells" = [127, 127])"});
  Process coordinator = farm.coordinator({"--until-done", "--lease-timeout", "3"});
  RandomStream random(12, 1, 1);
  std::map<int, int> before;
  for (int kill = 0; kill < 4; ++kill) {
    Process worker = farm.worker({"--slots", "2"});
    const int done = farm.done();
    REQUIRE(wait_until([&] { return farm.done() > done; }));
    sleep_s(random.uniform(0.0, 0.3));
    worker.signal(SIGKILL);
    worker.wait();
    CHECK(wait_until([&] { return farm.solvers_alive() == 0; }, 5.0));
    before = attempts_of_done(farm);
  }
  Process last = farm.worker({"--slots", "2", "--once"});
  CHECK(last.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(jobs);
  check_not_repeated(farm, before);
}

TEST_CASE("a worker that is told to stop checkpoints, gives its job back uncounted, and the next one resumes it") {
  FarmBench farm;
  farm.submit({.patterns = 1, .set = R"("phase_field.cells" = [383, 383])"});
  Process coordinator = farm.coordinator({"--until-done"});
  Process first = farm.worker({"--slots", "1"});
  REQUIRE(wait_until([&] { return farm.logged("\"progress\""); }));
  first.signal(SIGTERM);
  CHECK(first.wait() == 3);
  auto job = farm.explain(1);
  CHECK(job["state"] == "ready");
  REQUIRE(job["history"].size() == 1);
  CHECK(job["history"][0]["fault"] == "PLANNED_STOP");
  const auto checkpoint = farm.farm() / "checkpoints" / (job["key"].get<std::string>() + ".ckpt");
  CHECK(std::filesystem::exists(checkpoint));
  const long long stopped_at = farm.steps_logged("stopped").at(0);
  CHECK(stopped_at > 0);
  Process second = farm.worker({"--slots", "1", "--once"});
  CHECK(second.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(1);
  CHECK_FALSE(std::filesystem::exists(checkpoint));
  CHECK(farm.explain(1)["history"].size() == 1);
  CHECK(farm.steps_logged("progress").at(1) > stopped_at);  // it did not begin anew
}

TEST_CASE("a run that is killed, alone or with everything it started, goes on where it was when it is run again") {
  FarmBench farm;
  constexpr int jobs = 30;
  const auto campaign = farm.campaign({.patterns = jobs, .set = R"("phase_field.cells" = [79, 79])"}).string();
  RandomStream random(13, 1, 1);
  std::map<int, int> before;
  for (int kill = 0; kill < 3; ++kill) {
    Process run = farm.start({"run", campaign});
    sleep_s(random.uniform(0.6, 1.2));
    if (kill % 2 == 1)
      run.signal_group(SIGKILL);  // its daemons see that it died, checkpoint and end
    else
      farm.power_cut();
    run.wait();
    CHECK(wait_until([&] { return farm.processes_alive() == 0; }));
    before = attempts_of_done(farm);
  }
  CHECK(farm.verb({"run", campaign}).status == 0);
  farm.check_all_done(jobs);
  check_not_repeated(farm, before);
}

TEST_CASE("coordinator and workers killed in turn at random moments lose nothing") {
  FarmBench farm;
  constexpr int jobs = 80;
  farm.submit({.patterns = jobs, .set = R"("phase_field.cells" = [63, 63])"});
  RandomStream random(14, 1, 1);
  std::map<int, int> before;
  std::optional<Process> coordinator(farm.coordinator({"--lease-timeout", "2"}));
  std::optional<Process> workers[2] = {farm.worker({"--slots", "1"}), farm.worker({"--slots", "1"})};
  for (int kill = 0; kill < 12; ++kill) {
    sleep_s(random.uniform(0.05, 0.5));
    const int who = random.integer(0, 2);
    auto& victim = who == 2 ? coordinator : workers[who];
    victim->signal(SIGKILL);
    victim->wait();
    victim.reset();
    victim.emplace(who == 2 ? farm.coordinator({"--lease-timeout", "2"}) : farm.worker({"--slots", "1"}));
    if (kill % 4 == 3) {
      check_not_repeated(farm, before);
      before = attempts_of_done(farm);
    }
  }
  REQUIRE(wait_until([&] { return farm.done() == jobs; }));
  check_not_repeated(farm, before);
  for (auto& worker : workers) {
    worker->signal(SIGTERM);
    CHECK(worker->wait() == 3);
  }
  farm.check_all_done(jobs);
}
