// The programs as scripts see them: the JSON of every verb, exit statuses, Prometheus text. What is documented is a table here.
#include <fmt/format.h>
#include <signal.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/system/farm_bench.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Without --farm, for the verbs that have none.
FarmBench::Outcome fracfarm_alone(const FarmBench& farm, Words words) {
  static int n = 0;
  words.insert(words.begin(), std::string(FRACFARM_BIN_DIR) + "/fracfarm");
  const fs::path log = farm.folder() / fmt::format("alone-{}.out", n++);
  Process process(words, log);
  const int status = process.wait();
  return {status, text_of(log)};
}

fs::path drills(const FarmBench& farm, const std::string& name, int jobs, const std::string& set, int attempts = 3) {
  const fs::path file = farm.folder() / (name + ".toml");
  std::ofstream(file) << "name = \"" << name << "\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-" << jobs
                      << "\" }\nset = { " << set << " }\n[budget]\nwall_clock = \"1min\"\nattempts = " << attempts << "\n";
  return file;
}

// Four jobs are done, two are quarantined; nobody serves any more.
struct SettledFarm : FarmBench {
  fs::path good = drills(*this, "good", 4, "\"drill.act\" = \"sleep\"");
  fs::path bad = drills(*this, "bad", 2, "\"drill.act\" = \"nan\"", 1);
  SettledFarm() {
    REQUIRE(verb({"submit", good.string()}).status == 0);
    REQUIRE(verb({"submit", bad.string()}).status == 0);
    Process coordinator = this->coordinator({"--until-done"});
    Process worker = this->worker({"--slots", "1", "--once", "--node", "n1"});
    REQUIRE(worker.wait() == 0);
    REQUIRE(coordinator.wait() == 0);
  }
};

struct Shape {
  Words words;
  std::string schema;
  Words fields;  // beside `schema`
  int status = 0;
};

void check_shape(const Shape& shape, const FarmBench::Outcome& outcome) {
  INFO(fmt::format("{}\n{}", fmt::join(shape.words, " "), outcome.output));
  CHECK(outcome.status == shape.status);
  const json body = json::parse(outcome.output, nullptr, false);
  REQUIRE(body.is_object());  // one, and nothing beside it
  CHECK(body.value("schema", "") == shape.schema);
  for (const std::string& field : shape.fields) {
    INFO("lacks " << field);
    CHECK(body.contains(field));
  }
}

const Words change{"verb", "dry_run", "changed", "refused"};
const Words adopted{"entries", "known", "adopted", "loose", "refused"};

std::vector<Shape> shapes_of_a_farm(const SettledFarm& farm, const std::string& copy, const std::string& out) {
  return {
      {{"plan", farm.good.string()}, "fracfarm.plan/1", {"name", "jobs", "present", "done", "core_hours", "bytes", "classes"}},
      {{"submit", farm.good.string()}, "fracfarm.submit/1", {"campaign", "name", "total", "shared", "added"}},
      {{"run", farm.good.string()}, "fracfarm.run/1", {"exit_code", "elapsed_s", "status"}, 5},
      {{"status"},
       "fracfarm.status/1",
       {"farm_id", "build_id", "serving", "total", "settled", "counts", "verdicts", "classes", "campaigns", "rate_per_s", "eta_s",
        "finish_time", "faults", "workers", "paused", "suspects", "rechecks", "alarms"}},
      {{"jobs"}, "fracfarm.jobs/1", {"jobs", "more"}},
      {{"explain", "1"},
       "fracfarm.explain/1",
       {"id", "key", "state", "verdict", "why", "todo", "history", "node", "worker", "campaign_name"}},
      {{"explain", "worker", "n1"},
       "fracfarm.worker/1",
       {"worker", "node", "node_type", "now", "why", "todo", "blamed", "suspect", "canaries", "starts", "history"}},
      {{"failures"}, "fracfarm.failures/1", {"groups"}},
      {{"failures", "--explain"}, "fracfarm.failures/1", {"groups", "standing_out"}},
      {{"verify"}, "fracfarm.verify/1", {"records", "sound", "damaged", "repairs", "orphans"}},
      {{"doctor"}, "fracfarm.doctor/1", {"fit", "checks"}},
      {{"extract", "1", "--output", out}, "fracfarm.extract/1", {"files"}},
      {{"report", "-o", out + "/report.html"}, "fracfarm.report/1", {}},
      {{"retry", "5", "--dry-run"}, "fracfarm.change/1", change},
      {{"retry", "1"}, "fracfarm.change/1", change, 1},
      {{"hold", "--state", "READY", "--dry-run"}, "fracfarm.change/1", change},
      {{"release", "--state", "HELD", "--dry-run"}, "fracfarm.change/1", change},
      {{"cancel", "--state", "QUARANTINED", "--count", "1", "--dry-run"}, "fracfarm.change/1", change},
      {{"priority", "--to", "5", "--method", "drill", "--dry-run"}, "fracfarm.change/1", change},
      {{"pause", "--method", "drill"}, "fracfarm.change/1", change},
      {{"resume", "--method", "drill"}, "fracfarm.change/1", change},
      {{"recheck", "1", "--dry-run"}, "fracfarm.change/1", change},
      {{"drain"}, "fracfarm.error/1", {"fault", "message"}, 4},
      {{"explain", "99"}, "fracfarm.error/1", {"fault", "message"}, 2},
      {{"retry", "--class", "NONE"}, "fracfarm.problems/1", {"what", "problems"}, 2},
      {{"backup", copy}, "fracfarm.backup/1", {"file", "bytes"}},
      {{"restore", copy}, "fracfarm.restore/1", adopted},
  };
}

std::vector<Shape> shapes_without_a_farm(const std::string& scene, const std::string& mesh_scene, const std::string& record) {
  return {
      {{"pattern", "--id", "1"}, "fracfarm.pattern/1", {"cracks"}},
      {{"scene", "--check", scene}, "fracfarm.scene-check/1", {}},
      {{"solve", scene, "-o", record}, "fracfarm.summary/1", {"verdict", "time_to_failure", "peak_stress", "steps"}},
      {{"check", record}, "fracfarm.check/1", {"passed", "records"}},
      {{"show", record}, "fracfarm.show/1", {"verdict"}},
      {{"mesh", mesh_scene}, "fracfarm.mesh/1", {}},
  };
}

}  // namespace

TEST_CASE("every verb of the help prints one JSON object whose schema names its version, with the fields that scripts rely on") {
  SettledFarm farm;
  const std::string copy = (farm.folder() / "copy.db").string(), out = (farm.folder() / "out").string();
  std::set<std::string> seen{"coordinator", "worker", "drill", "metrics"};  // daemons; tested beside this
  for (const Shape& shape : shapes_of_a_farm(farm, copy, out)) {
    Words words = shape.words;
    words.push_back("--json");
    check_shape(shape, farm.verb(words));
    seen.insert(shape.words.front());
  }
  fs::rename(farm.farm() / "ledger", farm.folder() / "lost");
  check_shape({{"rebuild"}, "fracfarm.rebuild/1", adopted}, farm.verb({"rebuild", farm.good.string(), "--json"}));
  seen.insert("rebuild");

  const std::string scene = (farm.folder() / "scene.json").string(), record = (farm.folder() / "r.h5").string();
  std::ofstream(scene) << fracfarm_alone(farm, {"scene", "--material", "pbx", "--load", "uniaxial", "--id", "1"}).output;
  const std::string mesh_scene = (farm.folder() / "mesh.json").string();
  std::ofstream(mesh_scene)
      << fracfarm_alone(farm, {"scene", "--method", "fdem", "--material", "shale", "--load", "uniaxial", "--id", "1"}).output;
  for (const Shape& shape : shapes_without_a_farm(scene, mesh_scene, record)) {
    Words words = shape.words;
    words.push_back("--json");
    check_shape(shape, fracfarm_alone(farm, words));
    seen.insert(shape.words.front());
  }
  std::istringstream help(fracfarm_alone(farm, {"--help"}).output);
  const std::regex verb_line("^  ([a-z]+) +[a-z].*");
  std::smatch match;
  for (std::string line; std::getline(help, line);)
    if (std::regex_match(line, match, verb_line)) {
      INFO(match[1] << " is in the help and in no test of --json");
      CHECK(seen.contains(match[1]));
    }
}

TEST_CASE("exit statuses are those of the table in the README") {
  SettledFarm farm;
  const fs::path none = farm.folder() / "nowhere", typing_error = drills(farm, "typo", 1, "\"drill.akt\" = \"sleep\"");
  struct Row {
    int status;
    Words words;
  };
  const std::vector<Row> rows{{0, {"status"}},
                              {0, {"verify"}},
                              {0, {"metrics"}},
                              {0, {"doctor"}},
                              {1, {"retry", "1"}},
                              {2, {"status", "--colour"}},
                              {2, {"explain", "99"}},
                              {2, {"plan", typing_error.string()}},
                              {2, {"submit", typing_error.string()}},
                              {2, {"run", (none / "campaign.toml").string()}},
                              {2, {"retry", "--state", "DONE"}},
                              {2, {"priority", "1", "--to", "5000"}},
                              {2, {"rebuild"}},  // a ledger is there
                              {2, {"worker", "--slots", "0"}},
                              {2, {"coordinator", "--audit", "2"}},
                              {4, {"drain"}},
                              {4, {"restore", (none / "copy.db").string()}},
                              {5, {"run", farm.good.string()}}};
  for (const Row& row : rows) {
    const auto outcome = farm.verb(row.words);
    INFO(fmt::format("{}\n{}", fmt::join(row.words, " "), outcome.output));
    CHECK(outcome.status == row.status);
  }
  CHECK(fracfarm_alone(farm, {"frobnicate"}).status == 2);
  CHECK(fracfarm_alone(farm, {}).status == 2);
  for (const char* verb : {"status", "jobs", "verify", "metrics", "failures", "backup", "hold", "recheck"}) {
    INFO(verb);
    Words words{verb, "--farm", none.string()};
    if (verb == std::string("hold") || verb == std::string("recheck")) words.push_back("1");
    CHECK(fracfarm_alone(farm, words).status == 4);
  }
  Process coordinator = farm.coordinator();
  REQUIRE(wait_until([&] { return farm.json({"status"})["serving"].get<bool>(); }));
  CHECK(farm.verb({"coordinator"}).status == 4);  // held by another
  CHECK(farm.verb({"restore", (farm.folder() / "x").string()}).status == 4);
  coordinator.signal(SIGTERM);
  CHECK(coordinator.wait() == 0);
  Process run = farm.start({"run", drills(farm, "long", 1, "\"drill.seconds\" = 60").string(), "--workers", "1"});
  REQUIRE(wait_until([&] { return farm.json({"status"})["counts"]["leased"] == 1; }));
  run.signal(SIGINT);
  CHECK(run.wait() == 3);
  const fs::path shard = *std::find_if(fs::directory_iterator(farm.farm() / "store"), fs::directory_iterator(),
                                       [](const auto& it) { return it.path().extension() == ".tar"; });
  std::fstream(shard, std::ios::in | std::ios::out | std::ios::binary).seekp(2000).put('!');
  CHECK(farm.verb({"verify"}).status == 1);
}

TEST_CASE("a damaged record is repaired by verify --repair, also where a script asked for JSON") {
  SettledFarm farm;
  const auto place = farm.explain(1);
  const fs::path shard = farm.farm() / "store" / place["shard"].get<std::string>();
  std::fstream(shard, std::ios::in | std::ios::out | std::ios::binary).seekp(place["offset"].get<long>() + 1000).put('!');
  const auto found = farm.verb({"verify", "--repair", "--json"});
  INFO(found.output);
  CHECK(found.status == 1);
  const json body = json::parse(found.output, nullptr, false);
  REQUIRE(body.is_object());
  CHECK(body["damaged"].size() == 1);
  CHECK(body["repairs"] == 1);
  Process coordinator = farm.coordinator({"--until-done"});
  Process worker = farm.worker({"--slots", "1", "--once", "--node", "n2"});
  CHECK(worker.wait() == 0);
  CHECK(coordinator.wait() == 0);
  CHECK(farm.verb({"verify"}).status == 0);
  CHECK(farm.json({"status"})["alarms"].empty());
}

TEST_CASE("metrics keep the grammar of Prometheus text, line by line, while a farm works") {
  SettledFarm farm;
  const std::string text = farm.verb({"metrics"}).output;
  const std::regex help("# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) .+"), type("# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge)");
  const std::regex label("([a-zA-Z_][a-zA-Z0-9_]*)=\"((?:[^\"\\\\]|\\\\.)*)\"(,|$)");
  const std::regex sample("([a-zA-Z_:][a-zA-Z0-9_:]*)(?:\\{(.*)\\})? ([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?|NaN|[-+]?Inf)");
  std::set<std::string> typed, samples;
  std::string helped, current;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    std::smatch match;
    if (std::regex_match(line, match, help)) {
      helped = match[1];
    } else if (std::regex_match(line, match, type)) {
      CHECK(match[1] == helped);
      CHECK(typed.insert(match[1]).second);  // once, before its samples, which follow one another
      current = match[1];
      CHECK((match[2] == "counter") == current.ends_with("_total"));
    } else {
      REQUIRE(std::regex_match(line, match, sample));
      CHECK(match[1] == current);
      const std::string labels = match[2];
      CHECK(std::regex_replace(labels, label, "").empty());
      CHECK(samples.insert(match[1].str() + "{" + labels + "}").second);
    }
  }
  CHECK(text.ends_with("\n"));
  for (const char* line : {"fracfarm_up 0\n", "fracfarm_faults_total{fault=\"OUTPUT_BAD\"} 2\n"})
    CHECK(text.find(line) != std::string::npos);
}
