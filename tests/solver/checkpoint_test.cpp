#include "solver/checkpoint.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>

#include <atomic>
#include <filesystem>

#include "common/base/atomic_file.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
namespace fs = std::filesystem;

namespace {

struct TempFile {
  fs::path path = fs::temp_directory_path() / ("fracfarm_checkpoint_" + std::to_string(::getpid()) + ".bin");
  ~TempFile() { fs::remove(path); }
};

// Stops at the first chance, so that each call makes one step at most.
Result<RunResult> stopped_at_once(const Scene& scene, const fs::path& path) {
  static const std::atomic<bool> stop{true};
  RunControl control;
  control.checkpoint = path;
  control.checkpoint_key = "job";
  control.stop = &stop;
  return solve(scene, control);
}

Result<RunResult> resumed(const Scene& scene, const fs::path& path, const std::string& key = "job") {
  RunControl control;
  control.checkpoint = path;
  control.checkpoint_key = key;
  return solve(scene, control);
}

// Ends by its step budget: a checkpoint somewhere in the middle.
void cut_short(const Scene& scene, const fs::path& path, long long steps) {
  RunControl control;
  control.checkpoint = path;
  control.checkpoint_key = "job";
  control.step_budget = steps;
  const auto result = solve(scene, control);
  REQUIRE(result);
  REQUIRE(result->judgement.rule == "step_budget");
}

void check_same(const RunResult& a, const RunResult& b) {
  CHECK(a.steps == b.steps);
  CHECK(a.peak_stress == b.peak_stress);
  CHECK(a.energy_residual == b.energy_residual);
  CHECK(a.damage_initial == b.damage_initial);
  CHECK(a.damage_failure == b.damage_failure);
  CHECK(a.judgement.time_to_failure == b.judgement.time_to_failure);
  REQUIRE(a.frames.size() == b.frames.size());
  for (std::size_t f = 0; f < a.frames.size(); ++f) CHECK(a.frames[f].damage == b.frames[f].damage);
  for (std::size_t c = 0; c < a.series.columns.size(); ++c) CHECK(a.series.columns[c].values == b.series.columns[c].values);
}

}  // namespace

TEST_CASE("a run stopped and resumed any number of times ends with the bits of one that never stopped") {
  const TempFile file;
  Scene scene = cracked("steel", 24);  // the secant law yields: its moduli must come back too
  set_load(scene, Side::left, pull(5.0, scene.height));
  scene.loads[static_cast<std::size_t>(Side::left)][0].ramp = 2e-5;
  const auto whole = solve(scene, {});
  REQUIRE(whole);
  for (const long long steps : {37, 1, 50, 1, 1, 1}) cut_short(scene, file.path, steps);
  REQUIRE(fs::exists(file.path));
  const auto parts = resumed(scene, file.path);
  REQUIRE(parts);
  check_same(*whole, *parts);
  CHECK_FALSE(fs::exists(file.path));
}

TEST_CASE("a stopped run says so and leaves a checkpoint") {
  const TempFile file;
  const auto result = stopped_at_once(cracked("pbx", 12), file.path);
  REQUIRE(result);
  CHECK(result->stopped);
  CHECK(fs::exists(file.path));
}

TEST_CASE("a checkpoint of another job, damaged or cut is ignored and the run is right") {
  const TempFile file;
  const Scene scene = cracked("pbx", 16);
  const auto whole = solve(scene, {});
  REQUIRE(whole);
  cut_short(scene, file.path, 21);
  const std::string good = read_file(file.path, 1 << 30).value();
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  for (const std::string& bytes : {flipped, good.substr(0, good.size() / 2), good.substr(0, 30), std::string(), std::string(1000, '\n')}) {
    REQUIRE(write_atomically(file.path, bytes));
    check_same(*whole, resumed(scene, file.path).value());
  }
  REQUIRE(write_atomically(file.path, good));
  check_same(*whole, resumed(scene, file.path, "another job").value());
}

TEST_CASE("a whole checkpoint whose contents do not fit the scene is ignored") {
  const TempFile file;
  const Scene small = cracked("pbx", 12);
  Scene large = cracked("pbx", 16);
  large.phase_field.dt = 3e-7;
  Scene other = small;
  other.phase_field.dt = 3e-7;
  cut_short(other, file.path, 7);
  check_same(solve(large, {}).value(), resumed(large, file.path).value());
}

TEST_CASE("the file gives back its payload to its owner only") {
  const TempFile file;
  REQUIRE(write_checkpoint(file.path, "me", std::string("a\n\0b", 4)));
  CHECK(read_checkpoint(file.path, "me").payload == std::string("a\n\0b", 4));
  CHECK_FALSE(read_checkpoint(file.path, "you").payload);
  CHECK(read_checkpoint(file.path, "you").note.find("another run") != std::string::npos);
  CHECK(read_checkpoint(file.path.string() + ".none", "me").note.empty());
}
