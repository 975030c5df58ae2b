// The grammar of a scene file, block by block; one line a key. What needs several keys at once is checked after all of them are read.
#include "common/scene/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/json_text.hpp"
#include "common/scene/parse_parts.hpp"
#include "common/scene/pattern.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_cracks = 10'000;
constexpr std::uint64_t max_nodes = 4'000'000;
constexpr double max_frames = 10'000;
constexpr double max_stored_values = 1e9;                // nodes times frames, 4 GB as float
constexpr double default_frame_interval = 5.0e-6;        // s; the published dataset's own by its file sizes
constexpr double default_fdem_frame_interval = 10.0e-6;  // s
constexpr double max_aspect = 10.0;                      // of a cell

void read_domain(Fields& top, Scene& scene) {
  const json* value = top.value("domain");
  if (!value) return;
  Fields fields(*value, "domain", top.problems());
  fields.require({"width", "height"});
  fields.number("width", {1e-6, 1e3, "m"}, scene.width);
  fields.number("height", {1e-6, 1e3, "m"}, scene.height);
  fields.done();
}

void read_crack(const json& row, const std::string& path, Scene& scene, ProblemList& problems) {
  std::array<double, 4> ends{};
  if (!read_numbers(row, path, {-1e4, 1e4, "m"}, ends, problems)) return;
  Segment crack{.x0 = ends[0], .z0 = ends[1], .x1 = ends[2], .z1 = ends[3]};
  if (crack.x0 == crack.x1 && crack.z0 == crack.z1)
    problems.add(path, printed(row), "two different ends", "remove the row");
  else if (clip(crack, scene.width, scene.height))
    scene.cracks.push_back(crack);
}

void read_cracks(Fields& top, Scene& scene) {
  const json* value = top.value("cracks");
  if (!value) return;
  if (!value->is_array() || value->size() > max_cracks) {
    top.problems().add("cracks", printed(*value), fmt::format("a list of at most {} rows [x0, z0, x1, z1] in metres", max_cracks));
    return;
  }
  for (std::size_t i = 0; i < value->size(); ++i) read_crack((*value)[i], key_path("cracks", i), scene, top.problems());
}

void read_loads(Fields& top, Scene& scene) {
  const json* value = top.value("loads");
  if (!value) return;
  Fields fields(*value, "loads", top.problems());
  for (const auto& [name, side] : side_words)
    if (const json* load = fields.value(name))
      scene.loads[static_cast<std::size_t>(side)] = read_side(*load, fields.path(name), side, side_length(scene, side), top.problems());
  fields.done();
}

void read_initial(Fields& top, Scene& scene) {
  const json* value = top.value("initial");
  if (!value) return;
  Fields fields(*value, "initial", top.problems());
  if (const json* strain = fields.value("strain"))
    read_numbers(*strain, fields.path("strain"), {-0.1, 0.1, ""}, scene.initial.strain, top.problems());
  if (const json* gradient = fields.value("velocity_gradient"))
    read_numbers(*gradient, fields.path("velocity_gradient"), {-1e9, 1e9, "1/s"}, scene.initial.velocity_gradient, top.problems());
  fields.done();
}

// Absent times stay 0 here; fill_times() knows the materials.
void read_time(Fields& top, Scene& scene) {
  const json* value = top.value("time");
  if (!value) return;
  Fields fields(*value, "time", top.problems());
  fields.number("horizon", {0.0, 1e6, "s", true}, scene.horizon);
  fields.number("frame_interval", {0.0, 1e6, "s", true}, scene.frame_interval);
  fields.word("stop", stop_words, scene.stop);
  fields.done();
}

void fill_times(Scene& scene) {
  const bool fdem = scene.method == Method::fdem;
  if (scene.horizon == 0.0)
    for (const Layer& layer : scene.layers)
      scene.horizon = std::max(scene.horizon, fdem ? layer.material.fdem_horizon : layer.material.default_horizon);
  if (scene.frame_interval == 0.0) scene.frame_interval = fdem ? default_fdem_frame_interval : default_frame_interval;
}

// Another method's block may stand beside the chosen one: its keys and values must be right, but they are not this scene's.
void read_methods(Fields& top, Scene& scene) {
  Scene others;
  read_phase_field(top, scene.method == Method::phase_field ? scene : others);
  read_fdem(top, scene.method == Method::fdem ? scene : others);
}

// A domain, a material and a fitting length scale are needed by both methods; the characteristic width by one.
bool width_needed(const Scene& scene) {
  return scene.method == Method::phase_field && scene.phase_field.length_scale.kind != LengthScale::Kind::metres;
}

void read_sample(Fields& top, Scene& scene) {
  const json* value = top.value("sample");
  if (!value) return;
  Sample sample;
  Fields fields(*value, "sample", top.problems());
  fields.require({"set", "seed", "id", "load"});
  fields.word("set", crack_set_words, sample.set);
  fields.integer("seed", 0, UINT64_MAX, sample.seed);
  fields.integer("id", 1, UINT64_MAX, sample.id);
  std::array<Word<std::string_view>, named_loads.size()> loads;
  for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = {named_loads[i].name, named_loads[i].name};
  std::string_view load;
  if (fields.word("load", loads, load)) sample.load = load;
  fields.done();
  scene.sample = sample;
}

void check_frames(const Scene& scene, double values, ProblemList& problems) {
  const double frames = std::floor(scene.horizon / scene.frame_interval) + 1;
  if (frames > max_frames || frames * values > max_stored_values)
    problems.add("time.frame_interval", shortest(scene.frame_interval),
                 fmt::format("at most {} frames, and at most {} stored values in all", shortest(max_frames), shortest(max_stored_values)),
                 "a longer interval or a shorter horizon");
}

// The rest needs several keys, and is worth saying only of a scene whose keys are right.
void check_grid(const Scene& scene, ProblemList& problems) {
  const PhaseFieldSettings& settings = scene.phase_field;
  const std::uint64_t nodes = (static_cast<std::uint64_t>(settings.cells_x) + 1) * (static_cast<std::uint64_t>(settings.cells_z) + 1);
  if (nodes > max_nodes)
    problems.add("phase_field.cells", fmt::format("[{},{}]", settings.cells_x, settings.cells_z),
                 fmt::format("at most {} nodes", max_nodes));
  const double hx = scene.width / settings.cells_x, hz = scene.height / settings.cells_z;
  if (std::max(hx, hz) > max_aspect * std::min(hx, hz))
    problems.add("phase_field.cells", fmt::format("cells of {} by {} m", shortest(hx), shortest(hz)),
                 fmt::format("cells at most {} times as long as wide", shortest(max_aspect)),
                 fmt::format("squares need [{}, {}]", settings.cells_x, std::max(1LL, std::llround(scene.height / hx))));
  check_frames(scene, static_cast<double>(nodes), problems);
}

void check_method(Scene& scene, ProblemList& problems) {
  if (scene.stop == Stop::drop10 && scene.method != Method::fdem)
    problems.add("time.stop", "drop10", "failure or horizon for method phase_field", "failure");
  if (scene.method == Method::fdem) {
    check_frames(scene, 1.5 * triangle_count(scene), problems);
    return check_fdem(scene, problems);
  }
  scene.phase_field.plasticity = effective_plasticity(scene);
  if (scene.phase_field.plasticity != PlasticityModel::j2) scene.phase_field.plastic_drive = 0.0;
  check_grid(scene, problems);
  check_phase_field(scene, problems);
}

}  // namespace

Parsed<Scene> scene_from_json(const json& file) {
  if (is_drill(file)) return drill_from_json(file);
  ProblemList problems;
  Scene scene;
  Fields top(file, "", problems);
  top.require({"method", "domain", "material"});
  top.only("schema", scene_schema);  // a file without it is of the first version
  top.word("method", method_words, scene.method);
  read_domain(top, scene);
  read_methods(top, scene);
  if (const json* material = top.value("material")) scene.layers = read_layers(*material, scene.height, width_needed(scene), problems);
  read_cracks(top, scene);
  read_loads(top, scene);
  read_initial(top, scene);
  read_time(top, scene);
  read_sample(top, scene);
  top.done();
  if (!problems.empty()) return tl::unexpected(problems.take());

  fill_times(scene);
  check_method(scene, problems);
  if (!problems.empty()) return tl::unexpected(problems.take());
  return scene;
}

Parsed<Scene> parse_scene(std::string_view json_text) {
  Parsed<json> file = read_json(json_text, "scene");
  if (!file) return tl::unexpected(std::move(file.error()));
  return scene_from_json(*file);
}

}  // namespace fracfarm
