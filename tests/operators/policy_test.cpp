// What a farm of real programs does about faults, and what its operators see and do: blame, canaries, quarantine, the fuse, audits, and the
// verbs that move jobs.
#include <fmt/format.h>
#include <signal.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

namespace {

namespace fs = std::filesystem;

struct PolicyFarm : FarmBench {
  fs::path notices = folder() / "notices";

  void submit_drills(int patterns, const std::string& set, int attempts = 3) {
    const fs::path file = folder() / "drills.toml";
    std::ofstream(file) << "name = \"drills\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-" << patterns
                        << "\" }\nset = { " << set << " }\n[budget]\nwall_clock = \"1min\"\nattempts = " << attempts << "\n";
    const auto outcome = verb({"submit", file.string()});
    INFO(outcome.output);
    REQUIRE(outcome.status == 0);
  }
  Process telling_coordinator(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--notify", fmt::format("cat >> {}", notices.string())});
    return coordinator(std::move(more));
  }
  nlohmann::json status() { return json({"status"}); }
  std::string state_of(const std::string& node) {
    const nlohmann::json all = status();
    for (const auto& it : all["workers"])
      if (it["node"] == node) return it["state"];
    return "gone";
  }
  int count(const std::string& state) { return status()["counts"][state].get<int>(); }
  std::set<std::string> notice_kinds() const {
    std::set<std::string> kinds;
    std::ifstream file(notices);
    for (std::string line; std::getline(file, line);) {
      const auto it = nlohmann::json::parse(line, nullptr, false);
      if (it.is_object() && it["schema"] == "fracfarm.notice/1") kinds.insert(it["kind"].get<std::string>());
    }
    return kinds;
  }
  std::vector<int> order_of_starts() const {
    std::vector<int> jobs;
    for (const auto& entry : fs::directory_iterator(farm() / "log")) {
      if (!entry.path().filename().string().starts_with("worker-")) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        const auto said = nlohmann::json::parse(line, nullptr, false);
        if (said.is_object() && said.value("event", "") == "started") jobs.push_back(said["job"].get<int>());
      }
    }
    return jobs;
  }
};

const std::string fake = std::string(FRACFARM_BIN_DIR) + "/fake_solver";

}  // namespace

TEST_CASE("a node that fails what another does becomes suspect, proves itself after its repair, and everybody is told") {
  PolicyFarm farm;
  constexpr int jobs = 30;
  farm.submit_drills(jobs, "\"drill.seconds\" = 0.3");
  Process coordinator = farm.telling_coordinator({"--until-done", "--lease-timeout", "10"});
  Process good = farm.worker({"--slots", "1", "--once", "--node", "good"});
  REQUIRE(wait_until([&] { return farm.done() >= 1; }));
  std::optional<Process> bad(farm.worker({"--slots", "1", "--node", "bad", "--solver", fake}, {{"FAKE_SOLVER", "segfault"}}));
  REQUIRE(wait_until([&] { return !farm.status()["suspects"].empty(); }));
  const nlohmann::json told = farm.json({"explain", "worker", "bad"});
  CHECK(told["blamed"].get<int>() >= 3);
  CHECK(told["suspect"].is_string());
  REQUIRE(told["history"].size() >= 3);
  for (const auto& row : told["history"]) CHECK(row["fault"] == "SOLVER_CRASH");
  CHECK(farm.json({"explain", "worker", "good"})["blamed"] == 0);
  CHECK(farm.json({"failures"})["groups"][0]["fault"] == "SOLVER_CRASH");
  bad->signal(SIGTERM);
  bad->wait();
  bad.emplace(farm.worker({"--slots", "1", "--once", "--node", "bad"}));  // repaired
  CHECK(good.wait() == 0);
  CHECK(bad->wait() == 0);
  CHECK(coordinator.wait() == 0);
  const nlohmann::json after = farm.status();
  CHECK(after["faults"]["SOLVER_CRASH"].get<int>() >= 3);
  CHECK(farm.notice_kinds().contains("suspect"));
  if (farm.notice_kinds().contains("trusted")) {  // unless nothing was left to do
    CHECK(after["suspects"].empty());
    CHECK(after["rechecks"]["CANARY"]["PASSED"].get<int>() >= 1);
  }
  farm.check_all_done(jobs);
}

TEST_CASE(
    "jobs that fail by themselves are quarantined by two nodes' evidence, what they share is named, and they are tried again by class") {
  PolicyFarm farm;
  farm.submit_drills(6, "\"drill.act\" = [\"sleep\", \"crash\"]");
  const auto work = [&] {
    Process coordinator = farm.telling_coordinator({"--until-done"});
    Process one = farm.worker({"--slots", "1", "--once", "--node", "a"});
    Process two = farm.worker({"--slots", "1", "--once", "--node", "b"});
    CHECK(one.wait() == 0);
    CHECK(two.wait() == 0);
    CHECK(coordinator.wait() == 0);
  };
  work();
  CHECK(farm.count("done") == 6);
  CHECK(farm.count("quarantined") == 6);
  CHECK(farm.notice_kinds().contains("quarantined"));
  CHECK(farm.notice_kinds().contains("settled"));
  int by_two_nodes = 0;
  for (const auto& job : farm.jobs()) {
    if (job["state"] != "quarantined") continue;
    const nlohmann::json told = farm.explain(job["id"].get<int>());
    std::set<std::string> nodes;
    for (const auto& attempt : told["history"]) nodes.insert(attempt["node"].get<std::string>());
    by_two_nodes += nodes.size() == 2;
    CHECK(told["todo"].get<std::string>().find("fracfarm retry") != std::string::npos);
  }
  CHECK(by_two_nodes >= 1);
  const nlohmann::json failures = farm.json({"failures", "--explain"});
  REQUIRE_FALSE(failures["standing_out"].empty());
  CHECK(failures["standing_out"][0]["feature"] == "drill.act");
  CHECK(failures["standing_out"][0]["value"].get<std::string>().find("crash") != std::string::npos);

  CHECK(farm.json({"retry", "--class", "SOLVER_CRASH", "--count", "2", "--dry-run"})["changed"] == 2);
  CHECK(farm.count("quarantined") == 6);
  CHECK(farm.json({"retry", "--class", "SOLVER_CRASH", "--count", "2"})["changed"] == 2);
  CHECK(farm.count("quarantined") == 4);
  CHECK(farm.json({"retry", "--class", "OUTPUT_BAD"})["changed"] == 0);
  work();
  CHECK(farm.count("quarantined") == 6);
  CHECK(farm.verb({"verify"}).status == 0);
}

TEST_CASE("a class whose jobs fail is paused by its fuse with words, the notify command hears of it, and resume lets it go on") {
  PolicyFarm farm;
  constexpr int jobs = 56;
  farm.submit_drills(jobs, "\"drill.act\" = \"leak\"");  // without a memory limit: BAD_REQUEST, the job's own fault
  Process coordinator = farm.telling_coordinator({"--until-done"});
  Process worker = farm.worker({"--slots", "1", "--once"});
  REQUIRE(wait_until([&] { return !farm.status()["paused"].empty(); }));
  REQUIRE(wait_until([&] { return farm.count("leased") == 0; }));
  const nlohmann::json status = farm.status();
  CHECK(status["paused"][0]["why"].get<std::string>().find("failed for reasons of the jobs") != std::string::npos);
  CHECK(status["alarms"][0]["kind"] == "FUSE");
  const int left = status["counts"]["ready"].get<int>();
  CHECK(left > 0);
  CHECK(farm.explain(jobs)["why"].get<std::string>().find("paused") != std::string::npos);
  CHECK(farm.verb({"metrics"}).output.find("fracfarm_classes_paused 1\n") != std::string::npos);
  REQUIRE(wait_until([&] { return farm.notice_kinds().contains("paused"); }));
  CHECK(farm.json({"resume", "--dry-run"})["changed"] == 1);
  CHECK(farm.count("ready") == left);
  CHECK(farm.json({"resume"})["changed"] == 1);
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  CHECK(farm.count("quarantined") == jobs);
}

TEST_CASE("hold, release, cancel, priority, pause and drain move jobs and workers of a farm at work") {
  PolicyFarm farm;
  farm.submit_drills(9, "\"drill.seconds\" = 0.1");
  Process coordinator = farm.coordinator();
  REQUIRE(wait_until([&] { return farm.status()["serving"].get<bool>(); }));
  CHECK(farm.json({"hold", "2", "3"})["changed"] == 2);
  CHECK(farm.json({"cancel", "4"})["changed"] == 1);
  CHECK(farm.json({"priority", "9", "--to", "10"})["changed"] == 1);
  CHECK(farm.json({"priority", "1", "--to", "-10"})["changed"] == 1);
  CHECK(farm.json({"pause", "--reason", "the disk is moved"})["changed"] == 1);
  Process worker = farm.worker({"--slots", "1", "--node", "n1"});
  REQUIRE(wait_until([&] { return farm.state_of("n1") == "working"; }));
  CHECK(farm.explain(5)["why"].get<std::string>().find("the disk is moved") != std::string::npos);
  CHECK(farm.done() == 0);
  CHECK(farm.json({"resume"})["changed"] == 1);
  REQUIRE(wait_until([&] { return farm.done() == 6; }));
  CHECK(farm.order_of_starts() == std::vector<int>{9, 5, 6, 7, 8, 1});
  CHECK(farm.json({"release", "--state", "HELD"})["changed"] == 2);
  REQUIRE(wait_until([&] { return farm.done() == 8; }));
  CHECK(farm.count("cancelled") == 1);
  CHECK(farm.json({"drain", "n1", "--dry-run"})["changed"] == 1);
  CHECK(worker.running());
  CHECK(farm.json({"drain", "n1"})["changed"] == 1);
  CHECK(worker.wait() == 0);
  coordinator.signal(SIGTERM);
  CHECK(coordinator.wait() == 0);
  CHECK(farm.verb({"verify"}).status == 0);
}

TEST_CASE("results are computed again on another node: equal ones pass, one that differs raises the alarm and changes no result") {
  PolicyFarm farm;
  constexpr int jobs = 6;
  const bool differs = GENERATE(false, true);
  const fs::path odd = farm.folder() / "odd-solver";  // says another number of steps than it took
  std::ofstream(odd) << "#!/bin/sh\n" << FRACFARM_BIN_DIR << "/fracfarm-solve \"$@\" | sed -u 's/\"steps\":[0-9]*/\"steps\":7/'\n";
  fs::permissions(odd, fs::perms::owner_all);
  farm.submit_drills(jobs, "\"drill.seconds\" = 0.05");
  REQUIRE(farm.json({"hold", "--method", "drill"})["changed"] == jobs);
  Process coordinator = farm.telling_coordinator({"--audit", "1"});
  Process a = farm.worker({"--slots", "1", "--node", "a"});
  std::vector<std::string> other{"--slots", "1", "--node", "b"};
  if (differs) other.insert(other.end(), {"--solver", odd.string()});
  Process b = farm.worker(other);
  REQUIRE(wait_until([&] { return farm.state_of("a") == "working" && farm.state_of("b") == "working"; }));
  farm.json({"release", "--method", "drill"});
  REQUIRE(wait_until([&] {
    const nlohmann::json audits = farm.status()["rechecks"].value("AUDIT", nlohmann::json::object());
    return farm.done() == jobs && audits.value("PASSED", 0) + audits.value("DIFFERED", 0) == jobs;
  }));
  const nlohmann::json status = farm.status();
  CHECK(status["rechecks"]["AUDIT"].value("DIFFERED", 0) == (differs ? jobs : 0));
  CHECK(status["alarms"].empty() == !differs);
  if (differs) {
    CHECK(status["alarms"][0]["kind"] == "NONDETERMINISM");
    CHECK(wait_until([&] { return farm.notice_kinds().contains("alarm"); }));
  }
  a.signal(SIGTERM);
  b.signal(SIGTERM);
  CHECK(a.wait() == 3);
  b.wait();
  coordinator.signal(SIGTERM);
  CHECK(coordinator.wait() == 0);
  const nlohmann::json sampled = farm.json({"verify", "--sample", "0.5"});
  CHECK(sampled["records"].get<int>() <= jobs);
  CHECK(farm.json({"verify"})["sound"] == jobs);
}
