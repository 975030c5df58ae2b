// `fracfarm pattern` and `fracfarm scene` as a person calls them: what they print, and their exit statuses.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

struct Answer {
  int status = -1;
  std::string out;
};

// Standard output alone, unless `also` sends the other stream there.
Answer call(const std::string& arguments, const std::string& also = "2>/dev/null") {
  std::FILE* pipe = ::popen((FRACFARM_BIN_DIR "/fracfarm " + arguments + " " + also).c_str(), "r");
  REQUIRE(pipe);
  Answer answer;
  std::array<char, 4096> buffer;
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) answer.out.append(buffer.data(), got);
  answer.status = WEXITSTATUS(::pclose(pipe));
  return answer;
}

}  // namespace

TEST_CASE("pattern prints the cracks that the sample has, to the bit") {
  const Answer answer = call("pattern --id 5 --oblique --seed 7 --json");
  REQUIRE(answer.status == 0);
  const json body = json::parse(answer.out);
  const std::vector<Segment> expected = draw_pattern(CrackSet::oblique, 7, 5);
  REQUIRE(body["cracks"].size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(body["cracks"][i] == json{expected[i].x0, expected[i].z0, expected[i].x1, expected[i].z1});
  CHECK(body["schema"] == "fracfarm.pattern/1");
}

TEST_CASE("pattern prints a row for each crack as csv and as a table") {
  const std::size_t cracks = draw_pattern(CrackSet::orthogonal, 2026, 3).size();
  const std::string csv = call("pattern --id 3 --csv").out, table = call("pattern --id 3").out;
  CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == cracks + 1);
  CHECK(csv.starts_with("x0,z0,x1,z1\n"));
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) >= cracks + 2);
  CHECK(table.find('\033') == std::string::npos);
}

TEST_CASE("scene prints the sample's scene with its settings") {
  const Answer answer =
      call("scene --material steel --load biaxial --id 9 --set phase_field.length_scale=full --set 'phase_field.cells=[64,64]'");
  REQUIRE(answer.status == 0);
  const std::vector<Setting> settings{{"phase_field.length_scale", "\"full\""}, {"phase_field.cells", "[64,64]"}};
  const SampleChoice choice{find_material("steel"), find_load("biaxial"), CrackSet::orthogonal, 2026, 9};
  CHECK(parse_scene(answer.out).value() == sample_scene_with(choice, {}, settings).value());
}

TEST_CASE("mistakes are told all at once and end with status 2") {
  const Answer names = call("scene --material pbxx --load biaxia", "2>&1");
  CHECK(names.status == 2);
  for (const char* piece : {"3 problems", "did you mean 'pbx'?", "did you mean 'biaxial'?", "--id"})
    CHECK(names.out.find(piece) != std::string::npos);
  const Answer settings = call("scene --material pbx --load biaxial --id 1 --set phase_field.clf=1 --set time.horizon=-1 --json");
  CHECK(settings.status == 2);
  CHECK(json::parse(settings.out)["problems"].size() == 2);
  for (const char* bad : {"pattern", "pattern --id 0", "pattern --id -3", "pattern --id x", "pattern --id 1 --csv --json", "scene --set x",
                          "pattern --id 1 --colour"})
    CHECK(call(bad).status == 2);
}

TEST_CASE("scene --check tells a good file from a bad one") {
  const Answer good = call("scene --check " FRACFARM_SOURCE_DIR "/deploy/scenes/layers.json --json");
  CHECK(good.status == 0);
  CHECK(json::parse(good.out)["valid"] == true);
  CHECK(call("scene --check " FRACFARM_SOURCE_DIR "/deploy/campaigns/demo.toml").status == 2);
  CHECK(call("scene --check /nonexistent").status == 2);
}
