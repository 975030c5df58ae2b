// Golden numbers of whole runs, from an independent reference code that shares no line with this one (explicit, same step, conjugate
// gradients to 1e-8). Two such codes agreed to 4 digits; here 5 are asked for, because the schemes are the same and psi is good to 5e-5,
// and 4 where tiles rest, which the reference does not do.
#include <catch2/catch.hpp>

#include "common/scene/parse.hpp"
#include "solver/solve.hpp"

using namespace fracfarm;

namespace {

// One pattern of eight cracks in a 0.25 m plate, pulled at 1 m/s.
Scene reference_scene(const std::string& material, const std::string& sides, const std::string& dt) {
  const std::string text = R"({"schema": "fracfarm.scene/1", "method": "phase_field", "domain": {"width": 0.25, "height": 0.25},
    "cracks": [[0.124848, 0.146315, 0.135996, 0.146315], [0.051064, 0.214924, 0.063881, 0.214924], [0.047253, 0.219149, 0.082128, 0.219149],
               [0.097489, 0.127392, 0.134002, 0.127392], [0.077815, 0.048973, 0.077815, 0.090495], [0.160776, 0.1276, 0.160776, 0.17027],
               [0.135306, 0.225992, 0.135306, 0.244172], [0.136283, 0.121561, 0.136283, 0.145692]],
    "loads": {"top": {"normal_velocity": 1.0}, "bottom": {"normal_velocity": 1.0}, )" +
                           sides + R"(}, "time": {"horizon": 2.0e-4, "frame_interval": 5e-5, "stop": "failure"},
    "phase_field": {"cells": [127, 127], "plasticity": "secant", "dt": )" +
                           dt + R"(}, "material": ")" + material + "\"}";
  const auto scene = parse_scene(text);
  REQUIRE(scene);
  return *scene;
}

double at(const Series& series, const char* column, std::size_t step) { return series[column][step / 4]; }

RunResult solved(const Scene& scene, bool rests) {
  RunControl control;
  control.rules.work_where_it_moves = rests;
  const auto run = solve(scene, control);
  REQUIRE(run);
  return *run;
}

}  // namespace

TEST_CASE("shale pulled up and down breaks at the reference's step with its peak stress and energies") {
  const Scene scene = reference_scene("shale", R"("left": "free", "right": "free")", "2.5359404806607757e-07");
  for (const bool rests : {false, true}) {
    INFO("tiles rest: " << rests);
    const RunResult run = solved(scene, rests);
    const double share = rests ? 1e-4 : 1e-5;
    CHECK(run.steps == 685);
    CHECK(*run.judgement.time_to_failure == Approx(1.7371192292526443e-4).epsilon(1e-9));
    CHECK(run.peak_stress == Approx(6528057.687).epsilon(share));
    CHECK(at(run.series, "external_work", 400) == Approx(302.9133374).epsilon(share));
    // The reference averages the step's two strain energies arithmetically, 0.08 % more than the geometric mean that closes the ledger.
    CHECK(at(run.series, "released_energy", 400) == Approx(87.51235844).epsilon(1e-3));
    CHECK(run.energy_residual < 0.0003);
  }
}

TEST_CASE("tungsten pulled on four sides breaks from bottom to top within a step of the reference") {
  const std::string sides = R"("left": {"normal_velocity": 1.0}, "right": {"normal_velocity": 1.0})";
  const Scene scene = reference_scene("tungsten", sides, "1.9096630197972764e-07");
  for (const bool rests : {false, true}) {
    INFO("tiles rest: " << rests);
    const RunResult run = solved(scene, rests);
    CHECK(*run.judgement.time_to_failure == Approx(7.695941969782992e-5).margin(1.92e-7));
    // The reference solves psi to 1e-8 and lets nodes that a crack holds yield; here a correction of 5e-5 is accepted and they stay
    // elastic.
    CHECK(run.peak_stress == Approx(102353736.337).epsilon(rests ? 1e-4 : 1e-5));
    CHECK(at(run.series, "kinetic_energy", 300) == Approx(2636.263852).epsilon(rests ? 1e-4 : 3e-5));
    CHECK(run.energy_residual < 0.0003);
  }
}
