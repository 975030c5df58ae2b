// Campaign files: grammar with file and line, numbering of jobs, settings swept over, scenes made on demand.
#include "coordinator/campaign.hpp"

#include <catch2/catch.hpp>

#include <set>

#include "common/base/atomic_file.hpp"
#include "common/base/random.hpp"
#include "common/scene/parse.hpp"

using namespace fracfarm;

namespace {

const std::string small = R"(name = "small"
seed = 7
[[jobs]]
method    = "phase_field"
materials = ["pbx", "steel"]
loads     = ["uniaxial", "biaxial"]
patterns  = { orthogonal = "1-3,7", oblique = 5 }
set       = { "phase_field.cfl" = [0.5, 0.9], "time.stop" = "horizon" }
[budget]
wall_clock = "90 min"
attempts = 5
[output]
store = "shards"
)";

Campaign campaign_of(const std::string& text) {
  const Parsed<Campaign> campaign = parse_campaign(text, "c.toml");
  if (!campaign)
    for (const Problem& p : campaign.error()) UNSCOPED_INFO(p.key << " = " << p.value << "; allowed: " << p.limit);
  REQUIRE(campaign);
  return *campaign;
}

Problems problems_of(const std::string& text, std::string_view name = "c.toml") {
  const Parsed<Campaign> campaign = parse_campaign(text, name);
  return campaign ? Problems{} : campaign.error();
}

// The small campaign with one piece of its text replaced.
std::string with(const std::string& piece, const std::string& other) {
  std::string text = small;
  REQUIRE(text.find(piece) != std::string::npos);
  return text.replace(text.find(piece), piece.size(), other);
}

Problem only_problem(const std::string& piece, const std::string& other) {
  const Problems problems = problems_of(with(piece, other));
  for (const Problem& p : problems) UNSCOPED_INFO(p.key << " = " << p.value << "; allowed: " << p.limit);
  REQUIRE(problems.size() == 1);
  return problems[0];
}

std::string sample_file(const char* name) {
  return read_file(std::string(FRACFARM_SOURCE_DIR "/deploy/campaigns/") + name, 1'000'000).value();
}

}  // namespace

TEST_CASE("a campaign file is read to the last key") {
  const Campaign campaign = campaign_of(small);
  CHECK(campaign.name == "small");
  CHECK(campaign.seed == 7);
  CHECK(campaign.wall_budget_s == 5400);
  CHECK(campaign.attempts == 5);
  CHECK(campaign.store == "shards");
  REQUIRE(campaign.blocks.size() == 1);
  const JobBlock& block = campaign.blocks[0];
  CHECK(block.materials == std::vector<std::string>{"pbx", "steel"});
  CHECK(block.loads == std::vector<std::string>{"uniaxial", "biaxial"});
  REQUIRE(block.patterns.size() == 3);
  CHECK(block.patterns[0].last == 3);
  CHECK(block.patterns[1].first == 7);
  CHECK(block.patterns[2].set == CrackSet::oblique);
  REQUIRE(block.set.size() == 2);
  CHECK(block.set[0].values == std::vector<std::string>{"0.5", "0.9"});
  CHECK(block.set[1].values == std::vector<std::string>{"\"horizon\""});
  CHECK_FALSE(block.redraw);
}

TEST_CASE("budget and output have defaults") {
  const Campaign campaign = campaign_of(small.substr(0, small.find("[budget]")));
  CHECK(campaign.wall_budget_s == 8 * 3600);
  CHECK(campaign.attempts == 3);
  CHECK(campaign.store == "store");
}

TEST_CASE("jobs are numbered pattern by pattern, then material, load and settings") {
  const Campaign campaign = campaign_of(small);
  CHECK(job_count(campaign) == 5 * 2 * 2 * 2);
  std::vector<std::string> first;
  for (std::uint64_t i = 0; i < 9; ++i) {
    const JobSpec job = job_at(campaign, i);
    first.push_back(job.material + " " + job.load + " " + std::to_string(job.sample_id) + " " + job.settings.at(0).second);
  }
  CHECK(first == std::vector<std::string>{"pbx uniaxial 1 0.5", "pbx uniaxial 1 0.9", "pbx biaxial 1 0.5", "pbx biaxial 1 0.9",
                                          "steel uniaxial 1 0.5", "steel uniaxial 1 0.9", "steel biaxial 1 0.5", "steel biaxial 1 0.9",
                                          "pbx uniaxial 2 0.5"});
  CHECK(job_at(campaign, 3 * 8).sample_id == 7);
  CHECK(job_at(campaign, 4 * 8).set == CrackSet::oblique);
  CHECK(job_at(campaign, 4 * 8).sample_id == 5);
}

TEST_CASE("every index is another job, over several blocks, the last axis changing first") {
  const Campaign campaign = campaign_of(sample_file("sweep.toml"));
  CHECK(job_at(campaign, 1).settings == std::vector<Setting>{{"phase_field.cfl", "0.5"}, {"phase_field.length_scale", "\"full\""}});
  CHECK(job_at(campaign, 2).settings == std::vector<Setting>{{"phase_field.cfl", "0.7"}, {"phase_field.length_scale", "\"half\""}});
  CHECK(job_count(campaign) == 38);
  std::set<std::string> texts;
  for (std::uint64_t i = 0; i < job_count(campaign); ++i) texts.insert(canonical_text(scene_of(campaign, job_at(campaign, i))));
  CHECK(texts.size() == 38);
  CHECK(job_at(campaign, 29).block == 0);
  CHECK(job_at(campaign, 30).block == 1);
}

TEST_CASE("the scene of a job is the sample's with the job's settings") {
  const Campaign campaign = campaign_of(small);
  const Scene scene = scene_of(campaign, job_at(campaign, 7));
  Scene expected = sample_scene({find_material("steel"), find_load("biaxial"), CrackSet::orthogonal, 7, 1});
  expected.stop = Stop::horizon;
  CHECK(scene == expected);
  CHECK(scene_of(campaign, job_at(campaign, 6)).phase_field.cfl == 0.5);
}

TEST_CASE("redraw reaches the patterns") {
  const Campaign plain = campaign_of(with("oblique = 5", "oblique = \"1-200\""));
  const Campaign redrawn = campaign_of(with("oblique = 5", "oblique = \"1-200\", redraw = true"));
  int different = 0;
  for (std::uint64_t i = 0; i < job_count(plain); i += 8) {
    const Scene scene = scene_of(redrawn, job_at(redrawn, i));
    for (const Segment& crack : scene.cracks) CHECK((crack.x1 < 0.25 && crack.z1 < 0.25));
    different += scene != scene_of(plain, job_at(plain, i));
  }
  CHECK(different > 20);
}

TEST_CASE("the sample campaigns are campaigns, of the sizes that they state") {
  CHECK(job_count(campaign_of(sample_file("demo.toml"))) == 23);
  const Campaign published = campaign_of(sample_file("published.toml"));
  CHECK(job_count(published) == 2'100'000);
  const JobSpec last = job_at(published, 2'009'999);
  CHECK(last.material == "steel");
  CHECK(last.load == "biaxial");
  CHECK(last.set == CrackSet::oblique);
  CHECK(last.sample_id == 1000);
  const JobSpec mesh = job_at(published, 2'099'999);
  CHECK(mesh.method == Method::fdem);
  CHECK(mesh.material == "tungsten");
  CHECK(mesh.sample_id == 30'000);
  CHECK(scene_of(published, mesh).method == Method::fdem);
}

TEST_CASE("a campaign comes back from its canonical text, and the text from it") {
  for (const std::string& text :
       {small, sample_file("demo.toml"), sample_file("published.toml"), sample_file("sweep.toml"),
        with("\"time.stop\" = \"horizon\"", R"("phase_field.cells" = [64, 64], cracks = [], "loads.left" = ["free", "fixed"])"),
        with("\"time.stop\" = \"horizon\"", R"("initial.strain" = [[0,0,0],[0,1e-4,0]], cracks = [[], [[0.1,0.1,0.2,0.1]]])"),
        with("seed = 7", "seed = 9223372036854775807")}) {
    const Campaign campaign = campaign_of(text);
    const Campaign back = campaign_of(canonical_text(campaign));
    CHECK(canonical_text(back) == canonical_text(campaign));
    REQUIRE(job_count(back) == job_count(campaign));
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(50, job_count(campaign)); ++i)
      CHECK(scene_of(back, job_at(back, i)) == scene_of(campaign, job_at(campaign, i)));
  }
}

TEST_CASE("a list is an axis of the sweep unless the key's value is a list") {
  const auto values = [](const std::string& setting) {
    const Campaign campaign = campaign_of(with("\"time.stop\" = \"horizon\"", setting));
    for (const SettingAxis& axis : campaign.blocks[0].set)
      if (axis.key != "phase_field.cfl") return axis.values;
    return std::vector<std::string>{};
  };
  CHECK(values(R"("phase_field.cells" = [64, 65])") == std::vector<std::string>{"[64,65]"});
  CHECK(values(R"("phase_field.cells" = [[64, 65], [32, 33]])") == std::vector<std::string>{"[64,65]", "[32,33]"});
  CHECK(values(R"("loads.top" = ["free", "fixed"])") == std::vector<std::string>{"\"free\"", "\"fixed\""});
  CHECK(values(R"("loads.top" = [{normal_velocity = 1, to = 0.1}])").size() == 1);
  CHECK(values(R"("cracks" = [[0.1, 0.1, 0.2, 0.2]])").size() == 1);
  CHECK(values(R"("material.Gc" = [1, 2, 3])").size() == 3);
}

TEST_CASE("all mistakes of a campaign are reported at once, with file, line, key and a mend") {
  const Problems problems = problems_of(R"(name = "de mo"
sede = 1
[[jobs]]
method = "fdm"
materials = ["pbx", "steal", "pbx"]
loads = ["triaxial"]
patterns = { orthogonal = "5-2", obliqe = "1" }
set = { "phase_field.clf" = 0.9 }
[budget]
wall_clock = "eight"
)");
  const auto has = [&](const std::string& key, const std::string& suggestion) {
    for (const Problem& p : problems)
      if (p.key == key && p.suggestion == suggestion) return true;
    return false;
  };
  CHECK(problems.size() == 11);
  CHECK(has("c.toml:1: name", ""));
  CHECK(has("c.toml:2: sede", "did you mean 'seed'?"));
  CHECK(has("c.toml: seed", ""));
  CHECK(has("c.toml:4: jobs[0].method", "did you mean 'fdem'?"));
  CHECK(has("c.toml:5: jobs[0].materials[1]", "did you mean 'steel'?"));
  CHECK(has("c.toml:5: jobs[0].materials[2]", "remove it"));
  CHECK(has("c.toml:6: jobs[0].loads[0]", "did you mean 'uniaxial'?"));
  CHECK(has("c.toml:7: jobs[0].patterns.orthogonal", ""));
  CHECK(has("c.toml:7: jobs[0].patterns.obliqe", "did you mean 'oblique'?"));
  CHECK(has("c.toml:8: jobs[0].set.phase_field.clf", "did you mean 'cfl'?"));
  CHECK(has("c.toml:10: budget.wall_clock", ""));
}

TEST_CASE("a setting that fits one material and not another is found before any job runs") {
  // 4e-7 s is below 1.2 of the edge of pbx (587 ns) and above that of steel (296 ns).
  const Problem problem = only_problem("\"phase_field.cfl\" = [0.5, 0.9]", "\"phase_field.dt\" = 4e-7");
  CHECK(problem.key == "c.toml:8: jobs[0].set.phase_field.dt");
}

TEST_CASE("one bad value of an axis, or one bad pair of two axes, is found") {
  CHECK(only_problem("[0.5, 0.9]", "[0.5, 0.9, 1.3]").value == "1.3");
  const Problem pair =
      only_problem("\"time.stop\" = \"horizon\"", R"("time.horizon" = [1e-3, 1e-1], "time.frame_interval" = [1e-6, 1e-4])");
  CHECK(pair.key == "c.toml:8: jobs[0].set.time.frame_interval");
}

TEST_CASE("ranges of ids are ascending, from 1, and none stands twice") {
  for (const char* bad : {"\"0-3\"", "\"3-1\"", "\"1-3,3\"", "\"5,1\"", "\"1-\"", "\"-1\"", "\"\"", "\"1,,2\"", "\"a\"", "0", "-4", "1.5",
                          "\"1-9999999999999\"", "[1]"})
    CHECK(only_problem("\"1-3,7\"", bad).key == "c.toml:7: jobs[0].patterns.orthogonal");
  CHECK(campaign_of(with("\"1-3,7\"", "\"1-3, 4 - 6, 7\"")).blocks[0].patterns.size() == 2);
}

TEST_CASE("durations have units") {
  const auto seconds = [](const std::string& text) { return campaign_of(with("\"90 min\"", text)).wall_budget_s; };
  CHECK(seconds("\"8h\"") == 28800);
  CHECK(seconds("\"1.5 h\"") == 5400);
  CHECK(seconds("\"2d\"") == 172800);
  CHECK(seconds("\"30s\"") == 30);
  CHECK(seconds("45") == 45);
  for (const char* bad : {"\"8\"", "\"h\"", "\"8 hours\"", "\"-1h\"", "0", "\"1e9h\"", "true", "nan"})
    CHECK(only_problem("\"90 min\"", bad).key == "c.toml:10: budget.wall_clock");
}

TEST_CASE("a missing key is told with the line of its block") {
  CHECK(only_problem("loads     = [\"uniaxial\", \"biaxial\"]\n", "").key == "c.toml:3: jobs[0].loads");
  CHECK(only_problem("orthogonal = \"1-3,7\", oblique = 5", "redraw = true").key == "c.toml:7: jobs[0].patterns.orthogonal");
}

TEST_CASE("what is no TOML is refused with its line") {
  const Problems problems = problems_of("name = \"x\"\nseed = \n");
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].key == "c.toml:2");
  CHECK(problems_of("a = 1\na = 2\n").at(0).key == "c.toml:2");
}

TEST_CASE("dates and numbers that are not finite are refused with their line") {
  CHECK(only_problem("seed = 7", "seed = 1979-05-27").key == "c.toml:2: seed");
  CHECK(only_problem("0.9]", "inf]").key == "c.toml:8: jobs[0].set.phase_field.cfl[1]");
}

TEST_CASE("a campaign in JSON is the same campaign") {
  const Campaign campaign =
      campaign_of(R"({"name": "small", "seed": 7, "output": {"store": "shards"}, "budget": {"wall_clock": "90min", "attempts": 5},
    "jobs": [{"method": "phase_field", "materials": ["pbx", "steel"], "loads": ["uniaxial", "biaxial"], "patterns": {"orthogonal": "1-3,7", "oblique": 5},
              "set": {"phase_field.cfl": [0.5, 0.9], "time.stop": "horizon"}}]})");
  CHECK(canonical_text(campaign) == canonical_text(campaign_of(small)));
  CHECK(problems_of("{\"name\": 1", "c.json").at(0).key == "c.json");
  CHECK(problems_of("{\"name\": 1}", "c.json").at(0).key.find("c.json: ") == 0);
}

TEST_CASE("campaigns beyond the limits are refused") {
  CHECK(only_problem("\"1-3,7\"", "\"1-900000000000\"").limit == "at most 1000000000 jobs");
  std::string axis = "[0.001";
  for (int i = 2; i <= 1001; ++i) axis += ", " + std::to_string(i) + "e-3";
  CHECK(only_problem("[0.5, 0.9]", axis + "]").key.find("c.toml:8: jobs[0].set.phase_field.cfl") == 0);
  CHECK(problems_of(std::string(1'000'001, ' ')).at(0).limit == "at most 1 MB");
  CHECK_FALSE(problems_of("a = " + std::string(10'000, '[')).empty());
  CHECK(problems_of(with("[0.5, 0.9]", std::string(20, '[') + "1" + std::string(20, ']'))).at(0).limit == "at most 16 levels");
  CHECK_FALSE(problems_of("").empty());
  CHECK_FALSE(problems_of("{}").empty());
  CHECK_FALSE(problems_of("[]").empty());
}

TEST_CASE("4,000 broken campaigns are answered, never crashed on") {
  RandomStream draw(3, 2, 1);
  for (int i = 0; i < 4000; ++i) {
    std::string text = small;
    for (int edits = draw.integer(1, 3); edits > 0; --edits) {
      const auto at = static_cast<std::size_t>(draw.integer(0, static_cast<int>(text.size()) - 1));
      switch (draw.integer(0, 2)) {
        case 0:
          text[at] = static_cast<char>(draw.integer(0, 255));
          break;
        case 1:
          text.erase(at, static_cast<std::size_t>(draw.integer(1, 10)));
          break;
        default:
          text.insert(at, 1, "[]{}=,\"'\n-9.e"[draw.integer(0, 12)]);
          break;
      }
      if (text.empty()) text = "x";
    }
    const Parsed<Campaign> campaign = parse_campaign(text, "c.toml");
    if (!campaign) CHECK_FALSE(campaign.error().empty());
  }
}

TEST_CASE("a campaign of drills has acts as its axis, no materials and no loads") {
  const std::string text = R"(name = "drill"
seed = 1
[[jobs]]
method = "drill"
patterns = { orthogonal = "1-3" }
set = { "drill.act" = ["sleep", "crash"], "drill.attempts" = 1 }
)";
  const Campaign campaign = campaign_of(text);
  REQUIRE(job_count(campaign) == 6);
  std::set<std::string> texts;
  for (std::uint64_t i = 0; i < 6; ++i) texts.insert(canonical_text(scene_of(campaign, job_at(campaign, i))));
  CHECK(texts.size() == 6);
  CHECK(job_at(campaign, 1).material == "none");
  CHECK(scene_of(campaign, job_at(campaign, 1)).drill == DrillSettings{DrillAct::crash, 0.0, 1});
  CHECK(canonical_text(campaign_of(canonical_text(campaign))) == canonical_text(campaign));
  const auto refused = [&](const std::string& line) {
    std::string wrong = text;
    return problems_of(wrong.insert(wrong.find("patterns"), line + "\n")).size();
  };
  CHECK(refused("materials = [\"pbx\"]") == 1);
  CHECK(refused("loads = \"uniaxial\"") == 1);
  CHECK(refused("materials = \"none\"\nloads = \"none\"") == 0);
}
