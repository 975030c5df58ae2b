// The laws as the row kernels run them: closed forms, the energy ledger of breaking plates, float against double.
#include <catch2/catch.hpp>

#include <algorithm>

#include "solver/phasefield/passes.hpp"
#include "solver/phasefield/phase_field.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using namespace fracfarm::phasefield;

namespace {

RunResult run(const Scene& scene) {
  const auto result = solve(scene, {});
  REQUIRE(result);
  return *result;
}

struct Response {
  double psi, stress;
};

// A plate without cracks under the vertical strain e, damage at rest.
template <class Real>
Response stretched(const Scene& scene, double e) {
  Model model = build_model(scene);
  State<Real> state = make_state<Real>(model);
  Scratch<Real> scratch = make_scratch<Real>(model);
  const Kernels<Real>& kernels = chosen_kernels<Real>();
  for (int j = 0; j < model.grid.rows; ++j)
    for (int i = 0; i < model.grid.columns; ++i) state.uz[model.grid.index(i, j)] = static_cast<Real>(e * j * model.grid.hz);
  model.damage_tolerance = sizeof(Real) == 8 ? 1e-13 : 1e-6;
  strain(model, state, scratch, kernels);
  REQUIRE(solve_damage(model, state, scratch, kernels));
  const StressSum sum = respond(model, state, scratch, kernels, 0.0).stress;
  return {static_cast<double>(state.psi[model.grid.index(1, 2)]), sum.zz / (scene.width * scene.height)};
}

}  // namespace

// AT1: 2 (1 - psi) H = 3/8 G_c / w_0 past the threshold, so psi = 1 - H_c / H with H_c = 3/16 G_c / w_0 and an elastic range before it.
TEST_CASE("a homogeneous AT1 plate is elastic up to its threshold and follows the closed form past it") {
  Scene scene = square("pbx", 4);
  scene.phase_field.surface = SurfaceModel::at1;
  scene.phase_field.residual_stiffness = 0.0;
  const Material& m = scene.layers[0].material;
  const double C33 = m.elasticity.C33, H_c = 0.1875 * m.Gc / (0.5 * m.characteristic_width), e_c = std::sqrt(2.0 * H_c / C33);
  for (const double factor : {0.3, 0.99, 1.1, 2.0}) {
    const double e = factor * e_c, psi = factor > 1.0 ? 1.0 - 1.0 / (factor * factor) : 0.0;
    const Response exact = stretched<double>(scene, e), rough = stretched<float>(scene, e);
    CHECK(std::abs(exact.psi - psi) < 1e-11);
    CHECK(exact.stress == Approx((1 - psi) * (1 - psi) * C33 * e).epsilon(1e-10));
    CHECK(std::abs(rough.psi - psi) < 1e-4);
  }
}

TEST_CASE("the energy ledger of a breaking plate closes with every split, surface law and plane, in double and in float") {
  for (const Split split : {Split::seed, Split::none, Split::spectral, Split::volumetric_deviatoric, Split::star_convex})
    for (const SurfaceModel surface : {SurfaceModel::at2, SurfaceModel::at1})
      for (const Precision precision : {Precision::double_, Precision::float_}) {
        Scene scene = cracked("pbx", 40);
        scene.phase_field.split = split, scene.phase_field.surface = surface, scene.phase_field.precision = precision;
        if (split == Split::spectral) scene.phase_field.plane = Plane::stress;
        INFO(static_cast<int>(split) << " " << static_cast<int>(surface) << " " << static_cast<int>(precision));
        const RunResult result = run(scene);
        CHECK(result.series["released_energy"].back() > 0.0);
        CHECK(result.energy_residual < 0.005);
      }
}

TEST_CASE("float gives what double gives, and says so") {
  for (const char* material : {"pbx", "shale", "steel"}) {
    Scene scene = cracked(material, 48);
    const RunResult exact = run(scene);
    scene.phase_field.precision = Precision::float_;
    const RunResult rough = run(scene);
    CHECK(exact.kernel.find("/double") != std::string::npos);
    CHECK(rough.kernel.find("/float") != std::string::npos);
    CHECK(std::abs(exact.steps - rough.steps) <= 1);
    CHECK(rough.peak_stress == Approx(exact.peak_stress).epsilon(1e-4));
    CHECK(rough.energy_residual < 1.2 * exact.energy_residual + 1e-4);
    std::size_t moved = 0;
    for (std::size_t n = 0; n < exact.damage_failure.size(); ++n) moved += std::abs(exact.damage_failure[n] - rough.damage_failure[n]) > 0.05f;
    CHECK(moved < exact.damage_failure.size() / 100);
  }
}
