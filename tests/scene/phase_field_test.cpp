// The options of the phase-field block: every word, what goes with what, what is left out of the canonical text.
#include "tests/scene/scene_text.hpp"

using namespace fracfarm;
using nlohmann::json;

namespace {

// The good scene with these settings.
json settings(const json& values, const std::string& material = "pbx") {
  json scene = with("/material", material);
  scene["phase_field"] = values;
  return scene;
}

PhaseFieldSettings read(const json& values, const std::string& material = "pbx") {
  return scene_of(settings(values, material)).phase_field;
}

bool has_key(const json& values, const std::string& key, const std::string& material = "pbx") {
  return json::parse(canonical_text(scene_of(settings(values, material))))["phase_field"].contains(key);
}

}  // namespace

TEST_CASE("every option of the method has its words") {
  CHECK(read({{"split", "none"}}).split == Split::none);
  CHECK(read({{"split", "spectral"}}).split == Split::spectral);
  CHECK(read({{"split", "volumetric_deviatoric"}}).split == Split::volumetric_deviatoric);
  CHECK(read({{"split", "star_convex"}, {"star_convexity", 2.0}}).star_convexity == 2.0);
  CHECK(read({{"surface", "at1"}}).surface == SurfaceModel::at1);
  CHECK(read({{"plane", "stress"}}).plane == Plane::stress);
  CHECK(read({{"quadrature", "gauss"}}).quadrature == Quadrature::gauss);
  CHECK(read({{"precision", "float"}}).precision == Precision::float_);
  CHECK(read({{"crack_seeding", "nodes"}}).crack_seeding == CrackSeeding::nodes);
  CHECK(read({{"crack_seeding", "history"}}).crack_seeding == CrackSeeding::history);
  CHECK(read({{"step", "adaptive"}}).step_control == StepControl::adaptive);
  CHECK(read({{"plasticity", "j2"}, {"plastic_drive", 0.1}}, "steel").plasticity == PlasticityModel::j2);
}

TEST_CASE("the implicit integrators have their own numbers and their own steps") {
  const PhaseFieldSettings newmark =
      read({{"integrator", "newmark"}, {"newmark_beta", 0.3025}, {"newmark_gamma", 0.6}, {"cfl", 5.0}, {"staggered_passes", 1}});
  CHECK(newmark.newmark_beta == 0.3025);
  CHECK(newmark.cfl == 5.0);
  CHECK(newmark.staggered_passes == 1);
  CHECK(read({{"integrator", "quasi_static"}, {"dt", 1e-5}, {"staggered_tolerance", 1e-6}}).staggered_tolerance == 1e-6);
  CHECK(problem_at(settings({{"integrator", "quasi_static"}}), "phase_field.dt").value == "(missing)");
  problem_at(settings({{"integrator", "quasi_static"}, {"dt", 1e-5}, {"cfl", 0.9}}), "phase_field.cfl");
  CHECK(problem_at(settings({{"cfl", 5.0}}), "phase_field.cfl").suggestion.find("newmark") != std::string::npos);
}

TEST_CASE("a number that the chosen words leave without a meaning is a mistake") {
  problem_at(settings({{"star_convexity", 1.0}}), "phase_field.star_convexity");
  problem_at(settings({{"plastic_drive", 0.5}}, "steel"), "phase_field.plastic_drive");
  problem_at(settings({{"newmark_beta", 0.25}}), "phase_field.newmark_beta");
  problem_at(settings({{"staggered_tolerance", 1e-5}}), "phase_field.staggered_tolerance");
}

TEST_CASE("laws that do not go together are refused with what does") {
  CHECK(problem_at(settings({{"split", "spectral"}}, "shale"), "phase_field.split").suggestion == "seed");
  problem_at(settings({{"plane", "stress"}}, "shale"), "phase_field.plane");
  problem_at(settings({{"split", "star_convex"}}, "aluminum"), "phase_field.plasticity");
  CHECK(problems_of(settings({{"split", "star_convex"}, {"plasticity", "none"}}, "aluminum")).empty());
  problem_at(settings({{"split", "spectral"}, {"plasticity", "j2"}}, "aluminum"), "phase_field.plasticity");
  problem_at(settings({{"plane", "stress"}}, "aluminum"), "phase_field.plasticity");
  problem_at(settings({{"precision", "float"}, {"integrator", "newmark"}}), "phase_field.precision");
  problem_at(settings({{"precision", "float"}, {"quadrature", "gauss"}}), "phase_field.precision");
}

TEST_CASE("the canonical text has a setting only where it has an effect") {
  CHECK_FALSE(has_key(json::object(), "newmark_beta"));
  CHECK_FALSE(has_key(json::object(), "star_convexity"));
  CHECK_FALSE(has_key({{"plasticity", "j2"}, {"plastic_drive", 0.5}}, "plastic_drive"));  // pbx does not yield
  CHECK(has_key({{"plasticity", "j2"}, {"plastic_drive", 0.5}}, "plastic_drive", "steel"));
  CHECK(has_key({{"integrator", "newmark"}}, "newmark_gamma"));
  CHECK(has_key({{"integrator", "quasi_static"}, {"dt", 1e-6}}, "staggered_passes"));
  CHECK(has_key({{"split", "star_convex"}}, "star_convexity"));
}
