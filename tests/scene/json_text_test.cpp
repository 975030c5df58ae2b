// Reading JSON within bounds, and hostile bytes: whatever comes, an answer and no crash.
#include "common/scene/json_text.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/base/random.hpp"
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

Problem refused(const std::string& text, const JsonBounds& bounds = {}) {
  const Parsed<json> value = read_json(text, "file", bounds);
  REQUIRE_FALSE(value);
  return value.error().at(0);
}

}  // namespace

TEST_CASE("what nlohmann's parser reads, the bounded reader reads alike") {
  const std::string text = R"( {"a": [1, -2, 3.5, true, null, "\u00e9\n", {"b": {}}], "c": [], "d": 18446744073709551615} )";
  CHECK(*read_json(text, "file") == json::parse(text));
}

TEST_CASE("a key that stands twice is refused") { CHECK(refused(R"({"a": {"b": 1, "c": 2, "b": 3}})").value == "key 'b' twice"); }

TEST_CASE("text that is not JSON is refused with its place") {
  CHECK(refused("{\"a\": 1,\n \"b\": }").suggestion == "see line 2, column 7");
  for (const char* text : {"", "nul", "{", "[1,]", "{\"a\":NaN}", "[1] 2", "\"\xff\"", "01", "// x\n1"})
    CHECK(refused(text).limit == "JSON text");
}

TEST_CASE("numbers that no double holds are refused") {
  CHECK(refused("[1e999]").limit == "numbers that a double can hold");
  CHECK(refused("-1e400").limit == "numbers that a double can hold");
}

TEST_CASE("depth, count and size have limits") {
  CHECK(refused(std::string(200'000, '[')).value == "deeper nesting");
  CHECK(refused("[[[1]]]", {.max_depth = 2}).limit == "at most 2 levels");
  CHECK(read_json("[[1]]", "file", {.max_depth = 2}));
  CHECK(refused("[1,2,3]", {.max_values = 3}).limit == "at most 3 values");
  CHECK(refused("[1,2,3]", {.max_bytes = 6}).limit == "at most 6 B");
}

TEST_CASE("a hundred megabytes are refused without being read") {
  const std::string text(100'000'000, '[');
  CHECK(refused(text).value == "100 MB");
}

TEST_CASE("a hundred thousand cracks are refused by number") {
  json scene = good_scene();
  for (int i = 0; i < 10'001; ++i) scene["cracks"].push_back({0, 0, 1, 1});
  CHECK(problem_at(scene, "cracks").value == "a list of 10002 values");
}

TEST_CASE("ten thousand mistakes are cut to a hundred and a count") {
  json scene = good_scene();
  for (int i = 0; i < 5000; ++i) scene["cracks"].push_back({i});
  const Problems problems = problems_of(scene);
  CHECK(problems.size() == 101);
  CHECK(problems.back().value == "4900 more problems");
}

TEST_CASE("compact text has sorted keys, no blanks and the shortest numbers") {
  CHECK(compact_text(json::parse(R"({"b": [1, 2.50, 1e-6, 0.1], "a": "x\"y"})")) == R"({"a":"x\"y","b":[1,2.5,1e-06,0.1]})");
  CHECK(compact_text(json(-0.0)) == "0");
}

TEST_CASE("pretty text reads back as the same values and breaks only what is long") {
  json value = good_scene();
  for (int i = 0; i < 20; ++i) value["cracks"].push_back({0.1 * i, 0.2, 1.0 / 3, 0.4});
  CHECK(json::parse(pretty_text(value)) == value);
  CHECK(pretty_text(value).find("\"domain\": {\"height\": 0.2, \"width\": 0.25}") != std::string::npos);
  CHECK(pretty_text({{"a", 1}}) == "{\"a\": 1}\n");
}

TEST_CASE("20,000 broken scenes are answered, never crashed on") {
  const std::string good = good_scene().dump();
  RandomStream draw(1, 2, 3);
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = good;
    for (int edits = draw.integer(1, 4); edits > 0; --edits) {
      const auto at = static_cast<std::size_t>(draw.integer(0, static_cast<int>(text.size()) - 1));
      switch (draw.integer(0, 3)) {
        case 0:
          text[at] = static_cast<char>(draw.integer(0, 255));
          break;
        case 1:
          text.erase(at, static_cast<std::size_t>(draw.integer(1, 10)));
          break;
        case 2:
          text.insert(at, text.substr(static_cast<std::size_t>(draw.integer(0, static_cast<int>(at))), 12));
          break;
        default:
          text.insert(at, 1, "[]{},:\"-9e.\\"[draw.integer(0, 11)]);
          break;
      }
      if (text.empty()) text = "{";
    }
    const Parsed<Scene> scene = parse_scene(text);
    if (!scene) CHECK_FALSE(scene.error().empty());
    accepted += scene.has_value();
  }
  CHECK(accepted < 10'000);
}

TEST_CASE("every kind of value in every place is answered, never crashed on") {
  const std::vector<json> values{
      nullptr, true, -1, 1e308, UINT64_MAX, "", "free", json::array(), json::object(), {1, 2}, {{1}, {2}}, {{"material", nullptr}}};
  json full = json::parse(canonical_text(scene_of(good_scene())));
  full["sample"] = {{"set", "oblique"}, {"seed", 1}, {"id", 1}, {"load", "biaxial"}};
  full["fdem"] = {{"tier", "fast"}};
  const json flat = full.flatten();
  for (auto item = flat.begin(); item != flat.end(); ++item)
    for (const json& value : values)
      for (json::json_pointer place(item.key()); !place.empty(); place.pop_back()) {
        json scene = full;
        scene[place] = value;
        const Parsed<Scene> answer = parse_scene(scene.dump());
        CHECK((answer || !answer.error().empty()));
      }
}
