// Campaigns of real processes that nobody disturbs, and ends that were asked for.
#include <signal.h>

#include <catch2/catch.hpp>

#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

TEST_CASE("a campaign on two workers ends with every job done once") {
  FarmBench farm;
  farm.submit({.materials = R"(["pbx", "steel"])",
               .loads = R"(["uniaxial", "biaxial"])",
               .patterns = 5,
               .set = R"("phase_field.cells" = [31, 31])"});
  Process coordinator = farm.coordinator({"--until-done"});
  Process one = farm.worker({"--slots", "1", "--once", "--node", "a"});
  Process two = farm.worker({"--slots", "1", "--once", "--node", "b"});
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  CHECK(coordinator.wait() == 0);
  farm.check_all_done(20);
  for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
}

TEST_CASE("run does it all in one command, and again it finds nothing to do") {
  FarmBench farm;
  const auto campaign = farm.campaign({.patterns = 6}).string();
  CHECK(farm.verb({"run", campaign}).status == 0);
  farm.check_all_done(6);
  const auto starts = farm.starts();
  CHECK(farm.verb({"run", campaign}).status == 0);
  farm.check_all_done(6);
  CHECK(farm.starts() == starts);
  const auto folder = farm.farm() / "extracted";
  CHECK(farm.verb({"extract", "1", "6", "--output", folder.string()}).status == 0);
  CHECK(std::filesystem::exists(folder / "job-1.h5"));
  CHECK(std::filesystem::exists(folder / "job-6.h5"));
  CHECK(farm.verb({"extract", "7", "--output", folder.string()}).status == 2);  // there is no job 7
}

TEST_CASE("a drained worker finishes what it runs, takes no more and ends well") {
  FarmBench farm;
  farm.submit({.patterns = 40, .set = R"("phase_field.cells" = [127, 127])"});
  Process coordinator = farm.coordinator({"--until-done"});
  Process drained = farm.worker({"--slots", "1"});
  REQUIRE(wait_until([&] { return farm.done() >= 2; }));
  drained.signal(SIGUSR1);
  CHECK(drained.wait() == 0);
  const int done = farm.done();
  CHECK(done < 40);
  CHECK(farm.json({"status"})["counts"]["leased"] == 0);
  Process rest = farm.worker({"--slots", "2", "--once"});
  CHECK(rest.wait() == 0);
  farm.check_all_done(40);
  CHECK(farm.json({"status"})["faults"].value("NODE_LOST", 0) == 0);
}

TEST_CASE("a wall budget of a second ends a long simulation as censored by the clock") {
  FarmBench farm;
  const auto campaign = farm.campaign({.patterns = 1, .set = R"("phase_field.cells" = [511, 511])", .wall_clock = "1s"}).string();
  CHECK(farm.verb({"run", campaign}).status == 0);
  farm.check_all_done(1);
  const auto job = farm.jobs().at(0);
  CHECK(job["verdict"] == "censored");
  CHECK(job["failure_rule"] == "wall_clock");
  CHECK(std::filesystem::exists(farm.farm() / "checkpoints" / (job["key"].get<std::string>() + ".ckpt")));
}

TEST_CASE("records that are damaged are tried again and then quarantined, and run says so with status 5") {
  FarmBench farm;
  const std::string fake = std::string(FRACFARM_BIN_DIR) + "/fake_solver";
  farm.submit({.patterns = 1});
  Process coordinator = farm.coordinator({"--until-done"});
  Process worker = farm.worker({"--slots", "1", "--once", "--solver", fake}, {{"FAKE_SOLVER", "bit flip"}});
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  const auto job = farm.explain(1);
  CHECK(job["state"] == "quarantined");
  CHECK(job["history"].size() == 3);
  for (const auto& attempt : job["history"]) CHECK(attempt["fault"] == "OUTPUT_BAD");
  CHECK(farm.verb({"run", farm.campaign({.patterns = 1}).string()}).status == 5);
  CHECK(farm.verb({"verify"}).status == 0);
}
