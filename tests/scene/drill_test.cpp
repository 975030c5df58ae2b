// Scenes of rehearsals: no body, one block.
#include "common/scene/pattern.hpp"
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

json drill(json block = {{"act", "crash"}, {"seconds", 0.5}, {"attempts", 2}}) {
  return {{"schema", scene_schema}, {"method", "drill"}, {"drill", std::move(block)}};
}

}  // namespace

TEST_CASE("a drill has an act and no body, and its canonical text gives it back") {
  const Scene scene = scene_of(drill());
  CHECK(scene.method == Method::drill);
  CHECK(scene.drill == DrillSettings{DrillAct::crash, 0.5, 2});
  CHECK(scene.layers.empty());
  CHECK(material_name(scene) == "none");
  CHECK(canonical_text(scene) == R"({"drill":{"act":"crash","attempts":2,"seconds":0.5},"method":"drill","schema":"fracfarm.scene/1"})");
  CHECK(scene_of(json::parse(canonical_text(scene))) == scene);
}

TEST_CASE("every act has a name, and seconds and attempts may be left out") {
  for (const char* act : {"sleep", "crash", "hang", "leak", "truncated", "bit_flipped", "wrong_job", "nan", "ignore_term"}) {
    const Scene scene = scene_of(drill({{"act", act}}));
    CHECK(name_of(scene.drill.act) == act);
    CHECK(scene.drill.attempts == 0);
  }
}

TEST_CASE("what a drill cannot be is reported at once") {
  json wrong = drill({{"act", "explode"}, {"seconds", -1}, {"attempts", 1.5}, {"acts", 1}});
  wrong["material"] = "pbx";
  const Problems problems = problems_of(wrong);
  CHECK(problems.size() == 5);
  for (const char* key : {"drill.act", "drill.seconds", "drill.attempts", "material"}) problem_at(problems, key);
  CHECK(problem_at(problems, "drill.acts").suggestion == "did you mean 'act'?");
  problem_at(json{{"method", "drill"}}, "drill");
  problem_at(drill(json::object()), "drill.act");
}

TEST_CASE("samples of a drill differ by set, seed and id alone, and keys of other blocks are refused") {
  const auto text = [](std::uint64_t seed, std::uint64_t id) {
    return canonical_text(*drill_sample({.seed = seed, .id = id}, std::vector<Setting>{{"drill.act", "\"nan\""}}));
  };
  CHECK(text(1, 1) == text(1, 1));
  CHECK(text(1, 1) != text(1, 2));
  CHECK(text(1, 1) != text(2, 1));
  CHECK(scene_of(json::parse(text(3, 4))).sample == Sample{CrackSet::orthogonal, 3, 4, "none"});
  const Parsed<Scene> wrong = drill_sample({.id = 1}, std::vector<Setting>{{"phase_field.cfl", "0.5"}, {"drill.seconds", "x"}});
  REQUIRE_FALSE(wrong);
  CHECK(wrong.error().size() == 2);
}
