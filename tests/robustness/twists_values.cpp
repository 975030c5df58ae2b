#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

// Words that the grammar has, may have, and has not.
void any_option(json& scene, Draw& draw) {
  struct Option {
    const char* key;
    std::vector<json> values;
  };
  static const Option options[]{
      {"split", {"seed", "none", "spectral", "volumetric_deviatoric", "star_convex", "seeds"}},
      {"surface", {"at1", "at2"}},
      {"crack_seeding", {"slot", "nodes", "history"}},
      {"integrator", {"explicit", "newmark"}},
      {"step", {"fixed", "adaptive"}},
      {"quadrature", {"gll", "gauss"}},
      {"plasticity", {"none", "secant", "j2"}},
      {"precision", {"double", "float", "half"}},
      {"plane", {"strain", "stress"}},
      {"length_scale", {"half", "full", 0.002, "third"}},
      {"residual_stiffness", {0.0, 1e-12, 1e-3, 0.1, 0.11, -1e-9}},
  };
  for (int k = draw.integer(1, 3); k > 0; --k) {
    const Option& option = draw.pick(options);
    scene["phase_field"][option.key] = option.values[draw.index(option.values.size())];
  }
}

// Options that exclude each other are refused one by one above; here each with what it needs.
void other_split(json& scene, Draw& draw) {
  static constexpr const char* splits[]{"none", "spectral", "volumetric_deviatoric", "star_convex"};
  scene["phase_field"]["split"] = draw.pick(splits);
  scene["phase_field"]["plasticity"] = "none";
  if (scene["phase_field"]["split"] == "star_convex") scene["phase_field"]["star_convexity"] = draw.uniform(-1.0, 20.0);
  if (scene["material"] == "shale") scene["material"] = "pbx";
}
void plastic(json& scene, Draw& draw) {
  static constexpr const char* metals[]{"tungsten", "aluminum", "steel"};
  scene["material"] = draw.pick(metals);
  scene["phase_field"]["plasticity"] = "j2";
  scene["phase_field"]["plastic_drive"] = draw.uniform(0.0, 1.0);
}
void implicit(json& scene, Draw& draw) {
  json& settings = scene["phase_field"];
  const bool dynamic = draw.chance(0.7);
  settings["integrator"] = dynamic ? "newmark" : "quasi_static";
  settings.erase("cfl"), settings.erase("dt");
  if (dynamic)
    settings["cfl"] = draw.log_uniform(0.5, 20.0);
  else
    settings["dt"] = std::max(1e-12, number_at(scene, "/time/horizon")) / draw.uniform(5.0, 50.0);
  if (draw.chance(0.5)) settings["staggered_passes"] = draw.integer(1, 20);
}
void single_precision(json& scene, Draw&) { scene["phase_field"]["precision"] = "float"; }
void begun_again(json& scene, Draw& draw) {
  scene["phase_field"]["step"] = "adaptive";
  scene["phase_field"]["cfl"] = draw.uniform(0.9, 1.2);
}

void no_residual(json& scene, Draw&) { scene["phase_field"]["residual_stiffness"] = 0.0; }
void large_residual(json& scene, Draw& draw) { scene["phase_field"]["residual_stiffness"] = draw.uniform(1e-3, 0.1); }
void past_the_edge(json& scene, Draw& draw) { scene["phase_field"]["cfl"] = draw.uniform(0.95, 1.2); }
void small_step(json& scene, Draw& draw) { scene["phase_field"]["cfl"] = draw.log_uniform(1e-9, 0.5); }
void step_in_seconds(json& scene, Draw& draw) {
  scene["phase_field"].erase("cfl");
  scene["phase_field"]["dt"] = draw.log_uniform(1e-12, 1e-5);
}

constexpr Twist option_table[]{
    {"any_option", any_option},   {"other_split", other_split},           {"plastic", plastic},
    {"implicit", implicit},       {"single_precision", single_precision}, {"begun_again", begun_again},
    {"no_residual", no_residual}, {"large_residual", large_residual},     {"past_the_edge", past_the_edge},
    {"small_step", small_step},   {"step_in_seconds", step_in_seconds},
};

json* random_leaf(json& value, Draw& draw) {
  json* at = &value;
  while (at->is_structured() && !at->empty() && !(at != &value && draw.chance(0.1)))
    at = &*std::next(at->begin(), static_cast<std::ptrdiff_t>(draw.index(at->size())));
  return at;
}

void wrong_value(json& scene, Draw& draw) {
  static const json values[]{nullptr,
                             true,
                             "text",
                             "",
                             "1.0",
                             json::array(),
                             json::object(),
                             {1, 2, 3},
                             -1,
                             0,
                             1e300,
                             -1e300,
                             1e308,
                             5e-324,
                             -0.0,
                             1e-320,
                             18446744073709551615u,
                             "\xff\xfe",
                             std::string(5000, 'a'),
                             {{"a", {{"b", 1}}}}};
  *random_leaf(scene, draw) = draw.pick(values);
}
void wrong_number(json& scene, Draw& draw) {
  json* leaf = random_leaf(scene, draw);
  if (!leaf->is_number()) return;
  static constexpr double factors[]{-1.0, 0.0, 1e-300, 1e300, 1e12, 1e-12, 1e6, 1e-6, 1000.0, 0.001};
  *leaf = leaf->get<double>() * draw.pick(factors);
}
void missing_key(json& scene, Draw& draw) { scene.erase(std::next(scene.begin(), static_cast<std::ptrdiff_t>(draw.index(scene.size())))); }
void unknown_key(json& scene, Draw& draw) {
  static constexpr const char* keys[]{"materials", "Cracks", "load", "", "schema ", "phase-field", "dt", "\xc3\xa9"};
  scene[draw.pick(keys)] = 1;
}
void other_method(json& scene, Draw& draw) {
  static constexpr const char* words[]{"fdem", "drill", "phasefield", "", "PHASE_FIELD"};
  scene["method"] = draw.pick(words);
}

constexpr Twist value_table[]{
    {"wrong_value", wrong_value}, {"wrong_number", wrong_number}, {"missing_key", missing_key},
    {"unknown_key", unknown_key}, {"other_method", other_method},
};

void truncated(std::string& text, Draw& draw) { text.resize(draw.index(text.size() + 1)); }
void flipped_bytes(std::string& text, Draw& draw) {
  for (int k = draw.integer(1, 5); k > 0 && !text.empty(); --k) text[draw.index(text.size())] = static_cast<char>(draw.integer(0, 255));
}
// The first number of the file becomes a word that is no JSON, or a number that no double holds.
void no_number(std::string& text, Draw& draw) {
  static constexpr const char* words[]{"NaN",  "Infinity", "-Infinity", "nan", "1e999", "-1e999",
                                       "0x10", "1e",       "+1",        "01",  "1_000", "1e-999"};
  for (std::size_t tries = 0; tries < 20; ++tries) {
    const std::size_t at = draw.index(text.size());
    const std::size_t begin = text.find_first_of("0123456789", at);
    if (begin == std::string::npos) continue;
    const std::size_t end = text.find_first_not_of("0123456789.eE+-", begin);
    text.replace(begin, end == std::string::npos ? end : end - begin, draw.pick(words));
    return;
  }
}
void deep_nesting(std::string& text, Draw& draw) {
  const std::size_t depth = static_cast<std::size_t>(draw.integer(100, 200'000));
  text = "{\"cracks\":" + std::string(depth, draw.chance(0.5) ? '[' : '{');
}
void twice(std::string& text, Draw&) { text += text; }
void repeated_key(std::string& text, Draw&) { text.insert(1, "\"material\": \"steel\", \"domain\": {\"width\": 1, \"height\": 1},"); }
void noise(std::string& text, Draw& draw) {
  text.resize(draw.index(2000));
  for (char& c : text) c = static_cast<char>(draw.integer(0, 255));
}
void bare_value(std::string& text, Draw& draw) {
  static constexpr const char* values[]{"", "null", "[]", "3", "\"scene\"", "{}", "[{}]", "true", " ", "\xef\xbb\xbf{}"};
  text = draw.pick(values);
}

constexpr TextTwist text_table[]{
    {"truncated", truncated},       {"flipped_bytes", flipped_bytes},
    {"no_number", no_number},       {"no_number", no_number},
    {"deep_nesting", deep_nesting}, {"twice", twice},
    {"repeated_key", repeated_key}, {"noise", noise},
    {"bare_value", bare_value},
};

}  // namespace

std::span<const Twist> option_twists() { return option_table; }
std::span<const Twist> value_twists() { return value_table; }
std::span<const TextTwist> text_twists() { return text_table; }

}  // namespace fracfarm::robustness
