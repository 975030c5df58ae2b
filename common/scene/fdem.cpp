// The settings of FDEM: their keys, which of them go together, and their canonical spelling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/parse_parts.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr double max_triangles = 2e6;
constexpr double least_elements = 4.0;  // along the shorter side
constexpr double max_steps = 1e8;
constexpr double triangle_share = 0.4330127;  // of h^2: an equilateral triangle's area

bool is_digest(const std::string& text) { return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos; }

void read_mesh_file(Fields& fields, FdemSettings& settings) {
  const auto text = [&](std::string_view key, std::string& target) {
    const json* value = fields.value(key);
    if (!value || value->is_null()) return;
    if (value->is_string() && value->get_ref<const std::string&>().size() <= 1000)
      target = value->get<std::string>();
    else
      fields.problems().add(fields.path(key), printed(*value), "null or a text of at most 1000 characters");
  };
  text("mesh_file", settings.mesh_file);
  text("mesh_sha256", settings.mesh_sha256);
  if (!settings.mesh_file.empty() && !is_digest(settings.mesh_sha256))
    fields.problems().add(fields.path("mesh_sha256"), settings.mesh_sha256.empty() ? "(missing)" : settings.mesh_sha256,
                          "the SHA-256 of mesh_file, 64 hexadecimal digits", "sha256sum " + settings.mesh_file);
  if (settings.mesh_file.empty() && !settings.mesh_sha256.empty())
    fields.problems().add(fields.path("mesh_sha256"), settings.mesh_sha256, "only with mesh_file", "remove the key");
}

void check_materials(const Scene& scene, ProblemList& problems) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const Material& material = scene.layers[i].material;
    const std::string path = scene.layers.size() == 1 ? "material" : key_path(key_path("material.layers", i), "material");
    if (!material.cohesion)
      problems.add(path, material.name, "a material with friction, tensile_strength, shear_strength, GI and GII for method fdem",
                   "pbx, pbx5, shale or tungsten of the table have them");
  }
}

double fastest_wave(const Scene& scene) {
  double square = 0.0;
  for (const Layer& layer : scene.layers)
    square = std::max(square, std::max(layer.material.elasticity.C11, layer.material.elasticity.C33) / layer.material.density);
  return std::sqrt(square);
}

}  // namespace

double triangle_count(const Scene& scene) {
  return scene.width * scene.height / (triangle_share * scene.fdem.element_size * scene.fdem.element_size);
}

FdemSettings defaults_of(FdemTier tier) {
  FdemSettings settings;
  settings.tier = tier;
  if (tier == FdemTier::screening) settings.element_size *= 2.0;
  if (tier == FdemTier::reference) settings.dt_fraction *= 0.5;
  return settings;
}

void read_fdem(Fields& top, Scene& scene) {
  const json* value = top.value("fdem");
  if (!value) return;
  FdemSettings& settings = scene.fdem;
  Fields fields(*value, "fdem", top.problems());
  fields.word("tier", tier_words, settings.tier);
  settings = defaults_of(settings.tier);
  fields.number("element_size", {1e-7, 1e3, "m"}, settings.element_size);
  fields.word("softening", softening_words, settings.softening);
  fields.integer("mesh_seed", 0, UINT64_MAX, settings.mesh_seed);
  Precision precision{};
  if (fields.word("precision", precision_words, precision)) settings.precision = precision;
  fields.number("penalty", {0.1, 1e6, ""}, settings.penalty);
  fields.number("viscosity", {0.0, 10.0, ""}, settings.viscosity);
  fields.number("contact_penalty", {1e-3, 1e3, ""}, settings.contact_penalty);
  fields.number("dt_fraction", {0.0, 1.5, "", true}, settings.dt_fraction);
  fields.number("dt", {0.0, 1e3, "s", true}, settings.dt);
  if (fields.has("dt") && fields.has("dt_fraction"))
    top.problems().add(fields.path("dt"), "given with dt_fraction", "one of the two", "remove fdem.dt_fraction to set the step in seconds");
  read_mesh_file(fields, settings);
  fields.done();
}

constexpr double least_default = 8.0;  // p h / C11 where a scene gives none

// Tiers that compensate take the joints' compliance, about sqrt(3) / (p h), out of the triangles': what is left must be well above 0 in
// every direction, or the body pushes back the wrong way.
void check_penalty(const Scene& scene, ProblemList& problems) {
  if (scene.fdem.tier == FdemTier::reference) return;
  for (const Layer& layer : scene.layers) {
    const Elasticity& C = layer.material.elasticity;
    const double mean = 0.5 * (C.C11 + C.C33), stiffest = std::max(2.0 * C.C55, mean + std::hypot(0.5 * (C.C11 - C.C33), C.C13));
    const double least = 2.5 * stiffest / C.C11;
    if (scene.fdem.penalty.value_or(least_default) < least)
      problems.add("fdem.penalty", shortest(scene.fdem.penalty.value_or(least_default)),
                   fmt::format("at least {:.3g} for {} in the tiers that compensate the joints", least, layer.material.name),
                   "or fdem.tier \"reference\"");
  }
}

void check_fdem(const Scene& scene, ProblemList& problems) {
  check_materials(scene, problems);
  check_penalty(scene, problems);
  const double h = scene.fdem.element_size, shorter = std::min(scene.width, scene.height);
  if (h * least_elements > shorter * (1.0 + 1e-12))
    problems.add("fdem.element_size", shortest(h),
                 fmt::format("at most {} m: {} elements along the shorter side", shortest(shorter / least_elements), least_elements));
  if (triangle_count(scene) > max_triangles)
    problems.add("fdem.element_size", shortest(h),
                 fmt::format("at most {} triangles; this is about {:.3g}", max_triangles, triangle_count(scene)),
                 fmt::format("{:.3g} or more", std::sqrt(scene.width * scene.height / (triangle_share * max_triangles))));
  const double dt = scene.fdem.dt.value_or(0.05 * h / fastest_wave(scene));  // a guess: the bound is the mesh's
  if (!(scene.horizon / dt <= max_steps))
    problems.add("time.horizon", shortest(scene.horizon), fmt::format("at most {} steps of about {} s", shortest(max_steps), shortest(dt)));
}

// What follows the tier stays away, so that a later default of a tier changes no old scene only where it was written.
json fdem_json(const Scene& scene) {
  const FdemSettings& settings = scene.fdem;
  json out{{"element_size", settings.element_size},
           {"tier", spelled(tier_words, settings.tier)},
           {"softening", spelled(softening_words, settings.softening)},
           {"mesh_seed", settings.mesh_seed},
           {"viscosity", settings.viscosity},
           {"contact_penalty", settings.contact_penalty}};
  if (settings.precision) out["precision"] = spelled(precision_words, *settings.precision);
  if (settings.penalty) out["penalty"] = *settings.penalty;
  settings.dt ? out["dt"] = *settings.dt : out["dt_fraction"] = settings.dt_fraction;
  if (!settings.mesh_file.empty()) out.update({{"mesh_file", settings.mesh_file}, {"mesh_sha256", settings.mesh_sha256}});
  return out;
}

}  // namespace fracfarm
