// The settings of the phase-field method: their keys, which of them go together, and their canonical spelling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/parse_parts.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr double max_steps = 1e8;
constexpr double max_cfl = 1.2;  // explicit: past the edge, so that a test can show the instability
constexpr double max_implicit_cfl = 1000.0;

void read_cells(Fields& fields, PhaseFieldSettings& settings) {
  const json* value = fields.value("cells");
  if (!value) return;
  if (!value->is_array() || value->size() != 2) {
    fields.problems().add(fields.path("cells"), printed(*value), "a list of 2 integers: across and up");
    return;
  }
  std::array<int*, 2> targets{&settings.cells_x, &settings.cells_z};
  for (std::size_t i = 0; i < 2; ++i)
    if (const auto count = read_integer((*value)[i], key_path(fields.path("cells"), i), 1, 100'000, fields.problems()))
      *targets[i] = static_cast<int>(*count);
}

void read_length_scale(Fields& fields, LengthScale& scale) {
  const json* value = fields.value("length_scale");
  if (!value) return;
  if (value->is_number()) {
    scale.kind = LengthScale::Kind::metres;
    fields.number("length_scale", {1e-9, 1e3, "m"}, scale.metres);
    return;
  }
  for (const auto& [name, kind] : length_scale_words)
    if (*value == name) {
      scale.kind = kind;
      return;
    }
  fields.problems().add(fields.path("length_scale"), printed(*value), "half | full | a number of metres above 0");
}

void read_model(Fields& fields, PhaseFieldSettings& settings) {
  read_length_scale(fields, settings.length_scale);
  fields.number("residual_stiffness", {0.0, 0.1, ""}, settings.residual_stiffness);
  fields.word("crack_seeding", seeding_words, settings.crack_seeding);
  fields.word("surface", surface_words, settings.surface);
  fields.word("plane", plane_words, settings.plane);
  fields.word("split", split_words, settings.split);
  fields.number("star_convexity", {-1.0, 1e3, ""}, settings.star_convexity);
  fields.word("plasticity", plasticity_words, settings.plasticity);
  fields.number("plastic_drive", {0.0, 1.0, ""}, settings.plastic_drive);
}

void read_scheme(Fields& fields, PhaseFieldSettings& settings) {
  fields.word("quadrature", quadrature_words, settings.quadrature);
  fields.word("precision", precision_words, settings.precision);
  fields.word("integrator", integrator_words, settings.integrator);
  fields.number("cfl", {0.0, max_implicit_cfl, "", true}, settings.cfl);
  fields.number("dt", {0.0, 1e3, "s", true}, settings.dt);
  fields.word("step", step_control_words, settings.step_control);
  fields.number("newmark_beta", {0.0, 1.0, "", true}, settings.newmark_beta);
  fields.number("newmark_gamma", {0.5, 1.0, ""}, settings.newmark_gamma);
  fields.number("staggered_tolerance", {1e-12, 1.0, ""}, settings.staggered_tolerance);
  std::uint64_t passes = static_cast<std::uint64_t>(settings.staggered_passes);
  if (fields.integer("staggered_passes", 1, 100'000, passes)) settings.staggered_passes = static_cast<int>(passes);
}

// A number that the chosen words leave without a meaning is a mistake of the writer.
void check_companions(Fields& fields, const PhaseFieldSettings& settings) {
  const auto needs = [&](std::string_view key, bool fits, std::string_view limit) {
    if (fields.has(key) && !fits) fields.problems().add(fields.path(key), "given", std::string(limit), "remove the key");
  };
  const bool implicit = settings.integrator != Integrator::explicit_central;
  if (!implicit && settings.cfl > max_cfl)
    fields.problems().add(fields.path("cfl"), shortest(settings.cfl), "a number " + Range{0.0, max_cfl, "", true}.text(),
                          "0.9; integrator newmark takes longer steps");
  needs("star_convexity", settings.split == Split::star_convex, "only with split star_convex");
  needs("plastic_drive", settings.plasticity == PlasticityModel::j2, "only with plasticity j2");
  needs("newmark_beta", settings.integrator == Integrator::newmark, "only with integrator newmark");
  needs("newmark_gamma", settings.integrator == Integrator::newmark, "only with integrator newmark");
  needs("staggered_tolerance", implicit, "only with integrator newmark or quasi_static");
  needs("staggered_passes", implicit, "only with integrator newmark or quasi_static");
  needs("cfl", settings.integrator != Integrator::quasi_static, "a quasi-static run takes dt, seconds of the load's clock a step");
  if (fields.has("cfl") && fields.has("dt"))
    fields.problems().add(fields.path("dt"), "given with cfl", "one of the two", "remove phase_field.cfl to set the step in seconds");
  if (settings.integrator == Integrator::quasi_static && !fields.has("dt"))
    fields.problems().add(fields.path("dt"), "(missing)", "seconds of the load's clock a step", "a hundredth of the time to failure");
}

bool is_isotropic(const Material& material) {
  const Elasticity& c = material.elasticity;
  return std::abs(c.C11 - c.C33) <= 1e-9 * c.C11 && std::abs(c.C11 - c.C13 - 2.0 * c.C55) <= 1e-9 * c.C11;
}

void check_laws(const Scene& scene, ProblemList& problems) {
  const PhaseFieldSettings& settings = scene.phase_field;
  const auto split = std::string(spelled(split_words, settings.split));
  const bool isotropic = std::all_of(scene.layers.begin(), scene.layers.end(), [](const Layer& l) { return is_isotropic(l.material); });
  if (!isotropic && settings.split != Split::seed && settings.split != Split::none)
    problems.add("phase_field.split", split, "seed or none for a material that is not isotropic", "seed");
  if (!isotropic && settings.plane == Plane::stress)
    problems.add("phase_field.plane", "stress", "strain for a material that is not isotropic", "strain");
  const PlasticityModel plasticity = effective_plasticity(scene);
  const auto word = std::string(spelled(plasticity_words, plasticity));
  if (plasticity == PlasticityModel::secant && settings.split != Split::seed && settings.split != Split::none)
    problems.add("phase_field.plasticity", word, "none or j2 with split " + split, "\"plasticity\": \"none\"");
  if (plasticity == PlasticityModel::j2 && settings.split == Split::spectral)
    problems.add("phase_field.plasticity", word, "none with split spectral", "split volumetric_deviatoric goes with j2");
  if (plasticity != PlasticityModel::none && settings.plane == Plane::stress)
    problems.add("phase_field.plasticity", word, "none in plane stress", "\"plasticity\": \"none\"");
  const bool rows =
      settings.integrator == Integrator::explicit_central && settings.quadrature == Quadrature::gll && plasticity != PlasticityModel::j2;
  if (settings.precision == Precision::float_ && !rows)
    problems.add("phase_field.precision", "float", "double with gauss, newmark, quasi_static or j2", "double");
}

void check_step(const Scene& scene, ProblemList& problems) {
  const PhaseFieldSettings& settings = scene.phase_field;
  const double edge = step_edge(scene);
  const double dt = settings.dt.value_or(settings.cfl * edge);
  if (settings.integrator == Integrator::explicit_central && !(dt <= max_cfl * edge))
    problems.add("phase_field.dt", shortest(dt),
                 fmt::format("at most {} s, which is {} h / sqrt((C_max + C55) / rho)", shortest(max_cfl * edge), max_cfl),
                 "integrator newmark takes longer steps");
  if (!(scene.horizon / dt <= max_steps))
    problems.add("time.horizon", shortest(scene.horizon), fmt::format("at most {} steps of {} s", shortest(max_steps), shortest(dt)));
}

}  // namespace

void read_phase_field(Fields& top, Scene& scene) {
  const json* value = top.value("phase_field");
  if (!value) return;
  Fields fields(*value, "phase_field", top.problems());
  read_cells(fields, scene.phase_field);
  read_model(fields, scene.phase_field);
  read_scheme(fields, scene.phase_field);
  if (value->is_object()) check_companions(fields, scene.phase_field);
  fields.done();
}

void check_phase_field(const Scene& scene, ProblemList& problems) {
  check_laws(scene, problems);
  check_step(scene, problems);
}

double step_edge(const Scene& scene) {
  const bool star_convex = scene.phase_field.split == Split::star_convex;
  double fastest = 0.0;
  for (const Layer& layer : scene.layers) {
    const Elasticity& c = layer.material.elasticity;
    // A closed crack is (1 + gamma*) times as stiff as the bulk, which may be more than what the body is.
    const double closed = star_convex ? (1.0 + scene.phase_field.star_convexity) * (c.C13 + c.C55 * (2.0 / 3.0)) : 0.0;
    fastest = std::max({fastest, (std::max(c.C11, c.C33) + c.C55) / layer.material.density, closed / layer.material.density});
  }
  return std::min(scene.width / scene.phase_field.cells_x, scene.height / scene.phase_field.cells_z) / std::sqrt(fastest);
}

PlasticityModel effective_plasticity(const Scene& scene) {
  const bool yields =
      std::any_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) { return layer.material.plasticity.has_value(); });
  return yields ? scene.phase_field.plasticity : PlasticityModel::none;
}

json phase_field_json(const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  const PlasticityModel plasticity = effective_plasticity(scene);
  json out{{"cells", {settings.cells_x, settings.cells_z}},
           {"residual_stiffness", settings.residual_stiffness},
           {"crack_seeding", spelled(seeding_words, settings.crack_seeding)},
           {"surface", spelled(surface_words, settings.surface)},
           {"plane", spelled(plane_words, settings.plane)},
           {"split", spelled(split_words, settings.split)},
           {"plasticity", spelled(plasticity_words, plasticity)},
           {"quadrature", spelled(quadrature_words, settings.quadrature)},
           {"precision", spelled(precision_words, settings.precision)},
           {"integrator", spelled(integrator_words, settings.integrator)},
           {"step", spelled(step_control_words, settings.step_control)}};
  const LengthScale& scale = settings.length_scale;
  out["length_scale"] = scale.kind == LengthScale::Kind::metres ? json(scale.metres) : json(spelled(length_scale_words, scale.kind));
  settings.dt ? out["dt"] = *settings.dt : out["cfl"] = settings.cfl;
  if (settings.split == Split::star_convex) out["star_convexity"] = settings.star_convexity;
  if (plasticity == PlasticityModel::j2) out["plastic_drive"] = settings.plastic_drive;
  if (settings.integrator == Integrator::newmark)
    out.update({{"newmark_beta", settings.newmark_beta}, {"newmark_gamma", settings.newmark_gamma}});
  if (settings.integrator != Integrator::explicit_central)
    out.update({{"staggered_tolerance", settings.staggered_tolerance}, {"staggered_passes", settings.staggered_passes}});
  return out;
}

}  // namespace fracfarm
