// The farm's memory is lost, old or damaged: real programs bring it back, and nothing that was done is done again.
#include <signal.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;
namespace fs = std::filesystem;

namespace {

void finish(FarmBench& farm, const std::string& campaign) {
  const auto run = farm.verb({"run", campaign});
  INFO(run.output);
  REQUIRE(run.status == 0);
}

fs::path some_shard(const FarmBench& farm) {
  for (const auto& entry : fs::directory_iterator(farm.farm() / "store")) return entry.path();
  return {};
}

}  // namespace

TEST_CASE("a damaged record is found, computed again on demand, and the farm is whole again") {
  FarmBench farm;
  const auto campaign = farm.campaign({.patterns = 4}).string();
  finish(farm, campaign);
  const auto record = farm.explain(2);
  {
    std::fstream shard(farm.farm() / "store" / record["shard"].get<std::string>(), std::ios::in | std::ios::out | std::ios::binary);
    shard.seekp(record["offset"].get<std::streamoff>() + 1000);
    shard.write("damage", 6);
  }
  const auto verified = farm.verb({"verify", "--repair"});
  INFO(verified.output);
  CHECK(verified.status == 1);
  CHECK(verified.output.find("to be computed again: 1 job") != std::string::npos);
  CHECK(farm.explain(2)["state"] == "done");
  finish(farm, campaign);
  farm.check_all_done(4);
  CHECK(farm.explain(2)["peak_stress"] == record["peak_stress"]);
  const auto again = farm.explain(2);  // in a shard of its own session, where it may well lie at the same offset
  CHECK_FALSE((again["shard"] == record["shard"] && again["offset"] == record["offset"]));
}

TEST_CASE("an old copy of the ledger, made while a coordinator served, is put back and adopts what the shards have since") {
  FarmBench farm;
  constexpr int jobs = 24;
  const auto campaign = farm.campaign({.patterns = jobs, .set = R"("phase_field.cells" = [79, 79])"}).string();
  {
    Process run = farm.start({"run", campaign});
    REQUIRE(wait_until([&] { return farm.done() >= 3; }));
    const auto copied = farm.verb({"backup", (farm.folder() / "copy.db").string()});
    INFO(copied.output);
    REQUIRE(copied.status == 0);
    const int then = farm.done();
    REQUIRE(wait_until([&] { return farm.done() >= then + 4; }));
    farm.power_cut();
    run.wait();
  }
  REQUIRE(wait_until([&] { return farm.processes_alive() == 0; }));
  const int done = farm.done();
  const auto restored = farm.verb({"restore", (farm.folder() / "copy.db").string()});
  INFO(restored.output);
  REQUIRE(restored.status == 0);
  CHECK(farm.done() >= done);  // a record may lie in a shard whose report had not come yet
  finish(farm, campaign);
  farm.check_all_done(jobs);
  int twice = 0;
  for (const auto& [job, count] : farm.starts()) twice += count > 1;
  CHECK(twice <= 4);  // what ran when the power went
}

TEST_CASE("a ledger that is gone is made again from the shards and the campaign, and the run goes on") {
  FarmBench farm;
  const auto all = farm.campaign({.patterns = 12}).string();
  {
    const auto few = farm.campaign({.patterns = 5}).string();
    finish(farm, few);
  }
  fs::remove_all(farm.farm() / "ledger");
  const auto rebuilt = farm.json({"rebuild", all});
  CHECK(rebuilt["schema"] == "fracfarm.rebuild/1");
  CHECK(rebuilt["adopted"] == 5);
  CHECK(rebuilt["refused"].empty());
  CHECK(farm.done() == 5);
  CHECK(farm.verb({"rebuild", all}).status == 2);  // there is one now
  finish(farm, all);
  farm.check_all_done(12);
  CHECK(farm.starts().size() == 12);
  for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
  CHECK(fs::exists(some_shard(farm)));
}

TEST_CASE("the verbs of operators answer while a coordinator serves, in words and as JSON, with exit statuses") {
  FarmBench farm;
  farm.submit({.patterns = 6});
  Process coordinator = farm.coordinator({"--notify", "cat >> " + (farm.folder() / "told").string()});
  REQUIRE(wait_until([&] { return farm.done() == 0; }));
  CHECK(farm.json({"hold", "--material", "pbx", "--count", "2"})["changed"] == 2);
  CHECK(farm.json({"release", "--state", "held", "--dry-run"})["changed"] == 2);
  CHECK(farm.json({"priority", "--to", "5", "6"})["changed"] == 1);
  CHECK(farm.json({"pause", "--reason", "for lunch"})["classes"].size() == 1);
  CHECK(farm.explain(6)["why"].get<std::string>().find("for lunch") != std::string::npos);
  CHECK(farm.json({"resume"})["changed"] == 1);
  CHECK(farm.json({"cancel", "1", "2"})["changed"] == 2);
  CHECK(farm.json({"failures", "--explain"})["standing_out"].empty());
  CHECK(farm.json({"doctor"})["schema"] == "fracfarm.doctor/1");
  CHECK(farm.verb({"metrics"}).output.find("fracfarm_up 1") != std::string::npos);
  CHECK(farm.verb({"explain", "worker", "nobody"}).status == 2);
  CHECK(farm.verb({"hold"}).status == 2);
  CHECK(farm.verb({"release", "5"}).status == 1);  // it is not held
  Process worker = farm.worker({"--slots", "1", "--once"});
  CHECK(worker.wait() == 0);
  CHECK(farm.json({"explain", "worker", "worker-none"})["schema"] == "fracfarm.problems/1");
  REQUIRE(wait_until([&] { return fs::exists(farm.folder() / "told"); }));
  std::ifstream told(farm.folder() / "told");
  std::string line;
  REQUIRE(std::getline(told, line));
  CHECK(nlohmann::json::parse(line)["kind"] == "settled");
  coordinator.signal(SIGTERM);
  CHECK(coordinator.wait() == 0);
}
