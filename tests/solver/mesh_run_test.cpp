// Whole FDEM runs through the one time loop: both criteria, the damage at each of them, restarts, threads, rejected meshes, falling back.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "solver/solve.hpp"

using namespace fracfarm;
namespace fs = std::filesystem;

namespace {

// 36 mm of shale with a crack, torn apart at 10 m/s: broken in some 20 us.
Scene torn(std::string_view material = "shale") {
  Scene scene;
  scene.method = Method::fdem;
  scene.width = scene.height = 0.036;
  scene.layers = {{scene.height, *find_material(material)}};
  scene.cracks = {{0.0, 0.018, 0.012, 0.018}};
  for (const Side side : {Side::bottom, Side::top}) {
    SideLoad load;
    load.to = scene.width;
    load.normal_velocity = 10.0;
    load.tangential = Tangential::fixed;
    load.ramp = 1e-6;
    scene.loads[static_cast<std::size_t>(side)] = {load};
  }
  scene.horizon = 60e-6;
  scene.frame_interval = 5e-6;
  return scene;
}

std::optional<double> time_of(const RunResult& result, std::string_view rule) {
  for (const FailureTime& candidate : result.times)
    if (candidate.rule == rule) return candidate.time;
  return std::nullopt;
}

const MeshLayout& mesh_of(const RunResult& result) { return std::get<MeshLayout>(result.layout); }

struct TempFile {
  fs::path path = fs::temp_directory_path() / ("fracfarm_mesh_run_" + std::to_string(::getpid()) + ".bin");
  ~TempFile() { fs::remove(path); }
};

RunResult run(const Scene& scene, const RunControl& control = {}) {
  Result<RunResult> result = solve(scene, control);
  if (!result) FAIL(result.error().message);
  return std::move(*result);
}

void check_same(const RunResult& a, const RunResult& b) {
  CHECK(a.steps == b.steps);
  CHECK(a.judgement.time_to_failure == b.judgement.time_to_failure);
  CHECK(a.damage_failure == b.damage_failure);
  REQUIRE(a.frames.size() == b.frames.size());
  for (std::size_t f = 0; f < a.frames.size(); ++f) CHECK(a.frames[f].damage == b.frames[f].damage);
  for (std::size_t c = 0; c < a.series.columns.size(); ++c) CHECK(a.series.columns[c].values == b.series.columns[c].values);
}

}  // namespace

TEST_CASE("a torn plate loses its stress, breaks along its middle and keeps its ledger closed") {
  const RunResult result = run(torn());
  CHECK(result.judgement.verdict == Verdict::failed);
  REQUIRE(time_of(result, "drop10"));
  CHECK(*time_of(result, "drop10") < 50e-6);
  CHECK(result.energy_residual < 5e-3);
  const MeshLayout& layout = mesh_of(result);
  int broken = 0;
  for (std::size_t e = 0; e < layout.break_time.size(); ++e) {
    const float final = result.frames.back().damage[e];
    if (layout.mesh.edge_kind[e] == EdgeKind::crack)
      CHECK((final == 2.0f && std::isnan(layout.break_time[e])));
    else
      CHECK((final == 1.0f) == (layout.break_time[e] <= result.frames.back().time));
    broken += !std::isnan(layout.break_time[e]);
  }
  CHECK(broken >= 8);  // 24 mm of elements of 3 mm
  CHECK(result.series["crack_length"].front() == Approx(0.012));
  CHECK(result.series["crack_length"].back() > 0.03);
}

TEST_CASE("the damage at a criterion lies between that of the frames around it") {
  const RunResult result = run(torn());
  REQUIRE(result.judgement.time_to_failure);
  for (const Frame& frame : result.frames)
    for (std::size_t e = 0; e < frame.damage.size(); ++e)
      if (frame.time <= *result.judgement.time_to_failure)
        REQUIRE(frame.damage[e] <= result.damage_failure[e]);
      else
        REQUIRE(frame.damage[e] >= result.damage_failure[e]);
}

TEST_CASE("a run that stops by drop10 goes on to 1.8 times it") {
  Scene scene = torn();
  scene.stop = Stop::drop10;
  const RunResult result = run(scene);
  REQUIRE(time_of(result, "drop10"));
  const double end = result.series["step_time"].back();
  CHECK(end >= 1.8 * *time_of(result, "drop10"));
  CHECK(end < 1.8 * *time_of(result, "drop10") + 1e-6);
}

TEST_CASE("an FDEM run cut and resumed ends with the bits of one that never stopped") {
  const TempFile file;
  for (const char* material : {"shale", "tungsten"}) {
    const Scene scene = torn(material);
    const RunResult whole = run(scene);
    RunControl control;
    control.checkpoint = file.path;
    control.checkpoint_key = "job";
    for (const long long steps : {41LL, 1LL, whole.steps / 2}) {
      control.step_budget = steps;
      run(scene, control);
      REQUIRE(fs::exists(file.path));
    }
    control.step_budget.reset();
    check_same(run(scene, control), whole);
  }
}

TEST_CASE("threads change no bit of an FDEM run") {
  RunControl control;
  control.threads = 3;
  check_same(run(torn(), control), run(torn()));
}

TEST_CASE("a scene that no sound mesh can be made of is rejected with the reason") {
  Scene scene = torn();
  scene.cracks = {{0.018, 0.018, 0.0185, 0.018}};  // a sixth of an element
  const RunResult result = run(scene);
  CHECK(result.judgement.verdict == Verdict::rejected);
  CHECK_FALSE(result.judgement.rule.empty());
  CHECK(result.steps == 0);
}

TEST_CASE("a run past its bound begins again with half the step, and says so") {
  Scene scene = torn();
  scene.fdem.dt_fraction = 1.3;
  const RunResult result = run(scene);
  REQUIRE(result.notes.size() == 1);
  CHECK(result.notes[0].find("half the step") != std::string::npos);
  CHECK(result.energy_residual < 0.02);
}

TEST_CASE("a run that half the step does not save begins again in the reference tier, and its result is that tier's") {
  const double edge = run(torn()).dt / FdemSettings{}.dt_fraction;
  Scene scene = torn();
  scene.fdem.dt = 3.0 * edge;  // half of it is past the edge, too
  const RunResult result = run(scene);
  REQUIRE(result.notes.size() == 2);
  CHECK(result.notes[0].find("begun again with half the step after: ") == 0);
  CHECK(result.notes[1].find("begun again with the reference tier after: ") == 0);
  Scene reference = torn();
  reference.fdem.tier = FdemTier::reference;
  RunControl half;
  half.step_scale = 0.5;
  const RunResult straight = run(reference, half);
  check_same(result, straight);
  CHECK(straight.dt < 0.5 * edge);
  CHECK(result.kernel == straight.kernel);
  CHECK(result.energy_residual < 1e-3);
}

TEST_CASE("a run that no fall-back saves ends SOLVER_NUMERIC with evidence and gives no result") {
  RunControl wild;
  wild.step_scale = 8.0;  // past the edge even when it is halved, in the reference tier
  for (const FdemTier tier : {FdemTier::fast, FdemTier::reference}) {
    Scene scene = torn();
    scene.fdem.tier = tier;
    const Result<RunResult> result = solve(scene, wild);
    REQUIRE_FALSE(result);
    CHECK(result.error().fault == Fault::solver_numeric);
    CHECK(result.error().message.find("at step ") != std::string::npos);
  }
}
