// Arranging for the tests of this folder: a small good scene as JSON, and what the parser says of a changed one.
#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "common/scene/parse.hpp"

namespace fracfarm {

inline nlohmann::json good_scene() {
  return nlohmann::json::parse(R"({
    "schema": "fracfarm.scene/1", "method": "phase_field", "domain": {"width": 0.25, "height": 0.2}, "material": "pbx",
    "cracks": [[0.05, 0.10, 0.09, 0.10]], "loads": {"top": {"normal_velocity": 1.0}, "bottom": {"normal_velocity": 1.0}}
  })");
}

// The good scene with one value set, by JSON pointer.
inline nlohmann::json with(const std::string& pointer, nlohmann::json value) {
  nlohmann::json scene = good_scene();
  scene[nlohmann::json::json_pointer(pointer)] = std::move(value);
  return scene;
}

inline Scene scene_of(const nlohmann::json& file) {
  const Parsed<Scene> scene = parse_scene(file.dump());
  if (!scene)
    for (const Problem& p : scene.error()) UNSCOPED_INFO(p.key << " = " << p.value << "; allowed: " << p.limit << "; " << p.suggestion);
  REQUIRE(scene);
  return *scene;
}

inline Problems problems_of(const nlohmann::json& file) {
  const Parsed<Scene> scene = parse_scene(file.dump());
  return scene ? Problems{} : scene.error();
}

// The problem of a key; fails the test where the parser did not complain of it.
inline Problem problem_at(const Problems& problems, const std::string& key) {
  for (const Problem& p : problems)
    if (p.key == key) return p;
  for (const Problem& p : problems) UNSCOPED_INFO("found only " << p.key << " = " << p.value);
  FAIL("no problem at " << key);
  return {};
}

inline Problem problem_at(const nlohmann::json& file, const std::string& key) { return problem_at(problems_of(file), key); }

}  // namespace fracfarm
