// The rehearsal, with real daemons: every act is seen as the fault that it is, and its job is done in the end.
#include <catch2/catch.hpp>
#include <fstream>

#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

TEST_CASE("the drill verb sees every act as its fault, ends with 0 and leaves nothing behind") {
  TempFarm folder;
  const auto log = folder.path / "drill.json";
  Process drill({std::string(FRACFARM_BIN_DIR) + "/fracfarm", "drill", "--json", "--in", folder.path.string()}, log);
  CHECK(drill.wait(300.0) == 0);
  std::string text(std::istreambuf_iterator<char>(std::ifstream(log).rdbuf()), {});
  INFO(text);
  const auto said = nlohmann::json::parse(text.substr(text.find('{')), nullptr, false);
  REQUIRE(said.is_object());
  CHECK(said["acts"].size() == 9);
  for (const auto& act : said["acts"]) CHECK(act["as_expected"].get<bool>());
  int left = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) left += entry.path() != log;
  CHECK(left == 0);
}

TEST_CASE("drills that act in every attempt end quarantined, and the rest of the campaign is done") {
  FarmBench farm;
  const auto file = farm.folder() / "drills.toml";
  std::ofstream(file) << "name = \"drills\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-2\" }\n"
                         "set = { \"drill.act\" = [\"sleep\", \"wrong_job\"] }\n[budget]\nwall_clock = \"1min\"\nattempts = 2\n";
  REQUIRE(farm.verb({"submit", file.string()}).status == 0);
  Process coordinator = farm.coordinator({"--until-done"});
  Process worker = farm.worker({"--slots", "1", "--once"});
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  std::map<std::string, int> states;
  for (const auto& job : farm.jobs()) ++states[job["state"].get<std::string>()];
  CHECK(states == std::map<std::string, int>{{"done", 2}, {"quarantined", 2}});
  CHECK(farm.verb({"verify"}).status == 0);
}
