// `fracfarm pattern` and `fracfarm scene`: print what would be solved. They need no farm and change nothing.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/json_text.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "coordinator/cli/options.hpp"
#include "coordinator/cli/verb.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

constexpr std::uint64_t default_seed = 2026;  // the sample campaigns' own
constexpr std::uint64_t max_scene_bytes = std::uint64_t{8} << 20;

// Which pattern; the same options for both verbs.
struct PatternChoice {
  std::uint64_t id = 0;
  std::uint64_t seed = default_seed;
  bool oblique = false;
  PatternSettings settings;

  CrackSet set() const { return oblique ? CrackSet::oblique : CrackSet::orthogonal; }
};

// CLI11 would take -3 as a very large number.
std::string not_a_number(const std::string& text, std::uint64_t low) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size() && value >= low;
  return good ? "" : fmt::format("'{}' is not an integer from {} to {}", text, low, UINT64_MAX);
}

Option add_pattern_options(Command& app, PatternChoice& choice) {
  app.add_flag("--oblique", choice.oblique, "one set of 6 to 30 cracks, each with its own angle; else horizontal and vertical ones");
  app.add_option("--seed", choice.seed, "campaign seed of the patterns").with_default_shown().checked([](const std::string& text) {
    return not_a_number(text, 0);
  });
  app.add_flag("--redraw", choice.settings.redraw, "draw cracks that leave the domain again; else the part outside is dropped");
  return app.add_option("--id", choice.id, "sample id, from 1").checked([](const std::string& text) { return not_a_number(text, 1); });
}

json pattern_json(const PatternChoice& choice, const std::vector<Segment>& cracks) {
  json rows = json::array();
  for (const Segment& crack : cracks) rows.push_back({crack.x0, crack.z0, crack.x1, crack.z1});
  return {{"schema", "fracfarm.pattern/1"},
          {"set", name_of(choice.set())},
          {"seed", choice.seed},
          {"id", choice.id},
          {"redraw", choice.settings.redraw},
          {"domain", {{"width", choice.settings.width}, {"height", choice.settings.height}}},
          {"cracks", std::move(rows)}};
}

void print_csv(const std::vector<Segment>& cracks) {
  fmt::print("x0,z0,x1,z1\n");
  for (const Segment& crack : cracks)
    fmt::print("{},{},{},{}\n", shortest(crack.x0), shortest(crack.z0), shortest(crack.x1), shortest(crack.z1));
}

void print_table(const PatternChoice& choice, const std::vector<Segment>& cracks) {
  std::vector<std::vector<std::string>> rows{{"crack", "x0 mm", "z0 mm", "x1 mm", "z1 mm", "length mm", "angle deg"}};
  const auto mm = [](double metres) { return fmt::format("{:.3f}", metres * 1e3); };
  for (const Segment& c : cracks)
    rows.push_back({fmt::format("{}", rows.size()), mm(c.x0), mm(c.z0), mm(c.x1), mm(c.z1), mm(std::hypot(c.x1 - c.x0, c.z1 - c.z0)),
                    fmt::format("{:.1f}", std::atan2(c.z1 - c.z0, c.x1 - c.x0) * 57.29577951308232)});
  fmt::print("{} pattern {} of seed {}: {} cracks in {} x {} m\n{}", name_of(choice.set()), choice.id, choice.seed, cracks.size(),
             choice.settings.width, choice.settings.height, table_text(rows));
}

// key=value; a value that is not JSON stands for itself, as in phase_field.length_scale=full.
Setting setting_of(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  std::string value = equals < text.size() ? text.substr(equals + 1) : "";
  if (!read_json(value, "set")) value = json(value).dump(-1, ' ', false, json::error_handler_t::replace);
  return {text.substr(0, equals), value};
}

struct SceneChoice {
  PatternChoice pattern;
  std::string material, load, check_file, method = "phase_field";
  std::vector<std::string> set;
  bool as_json = false;
};

// Names against their tables; the same words of help as in a file.
Problems check_names(const SceneChoice& choice) {
  Problems problems;
  const auto expect = [&](std::string_view key, std::string_view given, const std::vector<std::string_view>& names) {
    if (std::find(names.begin(), names.end(), given) != names.end()) return;
    const std::string_view near = nearest(given, names);
    problems.push_back({std::string(key), given.empty() ? "(missing)" : std::string(given), join(names, " | "),
                        near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
  };
  std::vector<std::string_view> materials, loads;
  for (const Material& row : material_table()) materials.push_back(row.name);
  for (const NamedLoad& row : named_loads) loads.push_back(row.name);
  expect("--material", choice.material, materials);
  expect("--load", choice.load, loads);
  expect("--method", choice.method, {"phase_field", "fdem"});
  if (choice.pattern.id == 0) problems.push_back({"--id", "(missing)", "a sample id from 1", ""});
  for (const std::string& text : choice.set)
    if (text.find('=') == std::string::npos) problems.push_back({"--set", text, "key=value, as phase_field.cfl=0.8", ""});
  return problems;
}

int print_scene(const SceneChoice& choice) {
  if (const Problems problems = check_names(choice); !problems.empty()) return report_problems(problems, "scene", choice.as_json);
  std::vector<Setting> settings;
  for (const std::string& text : choice.set) settings.push_back(setting_of(text));
  const SampleChoice sample{.material = find_material(choice.material),
                            .load = find_load(choice.load),
                            .set = choice.pattern.set(),
                            .seed = choice.pattern.seed,
                            .id = choice.pattern.id,
                            .method = choice.method == "fdem" ? Method::fdem : Method::phase_field};
  const Parsed<Scene> scene = sample_scene_with(sample, choice.pattern.settings, settings);
  if (!scene) return report_problems(scene.error(), "scene", choice.as_json);
  fmt::print("{}", pretty_text(json::parse(canonical_text(*scene))));
  return exit_ok;
}

int check_scene(const SceneChoice& choice) {
  const Result<std::string> text = read_file(choice.check_file, max_scene_bytes);
  if (!text)
    return report_problems({{"--check", choice.check_file, "a scene file that can be read", text.error().message}}, choice.check_file,
                           choice.as_json);
  const Parsed<Scene> scene = parse_scene(*text);
  if (!scene) return report_problems(scene.error(), choice.check_file, choice.as_json);
  const std::vector<std::string> warnings = scene_warnings(*scene);
  if (choice.as_json) {
    fmt::print("{}", pretty_text({{"schema", "fracfarm.scene-check/1"},
                                  {"valid", true},
                                  {"warnings", warnings},
                                  {"scene", json::parse(canonical_text(*scene))}}));
    return exit_ok;
  }
  const std::string grid = scene->method == Method::fdem
                               ? fmt::format("elements of {}", engineering(scene->fdem.element_size, "m"))
                               : fmt::format("{} x {} cells", scene->phase_field.cells_x, scene->phase_field.cells_z);
  fmt::print("{}: {} {} {}, {} layer{}, {} cracks, {}, horizon {}\n", ink("valid", Ink::green, stdout), choice.check_file,
             name_of(scene->method), material_name(*scene), scene->layers.size(), scene->layers.size() == 1 ? "" : "s",
             scene->cracks.size(), grid, engineering(scene->horizon, "s"));
  for (const std::string& warning : warnings) fmt::print("{} {}\n", ink("warning:", Ink::yellow, stdout), warning);
  return exit_ok;
}

}  // namespace

int run_pattern(int argc, char** argv) {
  Command app("Print one random crack pattern (seed paper, eqs 18-22) as a dataset's sample has it.", "fracfarm pattern");
  PatternChoice choice;
  bool as_json = false, as_csv = false;
  add_pattern_options(app, choice).required();
  const Option json_flag = app.add_flag("--json", as_json, "one JSON object, metres");
  app.add_flag("--csv", as_csv, "rows x0,z0,x1,z1 in metres").excludes(json_flag);
  if (const auto status = app.parse(argc, argv)) return *status;
  const std::vector<Segment> cracks = draw_pattern(choice.set(), choice.seed, choice.id, choice.settings);
  if (as_json)
    fmt::print("{}", pretty_text(pattern_json(choice, cracks)));
  else
    as_csv ? print_csv(cracks) : print_table(choice, cracks);
  return exit_ok;
}

int run_scene(int argc, char** argv) {
  Command app("Print the scene of one sample as `fracfarm solve` takes it, or check a scene file.", "fracfarm scene");
  SceneChoice choice;
  add_pattern_options(app, choice.pattern);
  app.add_option("--material", choice.material, "a name of the material table");
  app.add_option("--load", choice.load, "uniaxial or biaxial");
  app.add_option("--method", choice.method, "phase_field or fdem");
  app.add_option("--set", choice.set, "a scene key and its value, as phase_field.cfl=0.8; may be given again").repeatable();
  app.add_option("--check", choice.check_file, "check this scene file and print nothing of a sample");
  app.add_flag("--json", choice.as_json, "problems, and what --check found, as one JSON object");
  if (const auto status = app.parse(argc, argv)) return *status;
  return choice.check_file.empty() ? print_scene(choice) : check_scene(choice);
}

}  // namespace fracfarm::cli
