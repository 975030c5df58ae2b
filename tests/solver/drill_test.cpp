// Rehearsal jobs: what ends well is a sound record, what is spoiled is found by the validator under the right digest.
#include <catch2/catch.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/build_info.hpp"
#include "common/base/hash.hpp"
#include "common/record/check.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "solver/program/drill.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;

namespace {

struct Rehearsal {
  TempFarm folder;
  Scene scene;
  Task task;

  explicit Rehearsal(DrillAct act, int attempts = 0, int attempt = 1)
      : scene(*drill_sample({.seed = 5, .id = 7}, std::vector<Setting>{{"drill.attempts", std::to_string(attempts)}})) {
    scene.drill.act = act;
    task.key = job_key(canonical_text(scene), build_info().build_id);
    task.output = folder.path / "record.h5";
    task.attempt = attempt;
  }
  Result<TaskEnd> run() {
    return run_task(task, scene, Keeping::scratch, [](long long, double, double) {});
  }
  // Names of the broken rules.
  std::vector<std::string> broken(const TaskEnd& end) {
    const std::string bytes = read_file(task.output, 1 << 20).value();
    CHECK(sha256_hex(bytes) == end.summary.record_sha256);
    std::vector<std::string> names;
    for (const Check& check : check_record_bytes(bytes, {.key = task.key}).checks)
      if (!check.passed) names.push_back(check.name);
    return names;
  }
};

}  // namespace

TEST_CASE("a drill that ends well leaves a sound record of nothing: censored, by the rule drill") {
  Rehearsal rehearsal(DrillAct::sleep);
  const auto end = rehearsal.run();
  REQUIRE(end);
  CHECK(rehearsal.broken(*end).empty());
  CHECK(end->summary.verdict == Verdict::censored);
  CHECK(end->summary.failure_rule == "drill");
}

TEST_CASE("a spoiled record breaks a rule, each its own") {
  for (const auto& [act, rule] : {std::pair{DrillAct::truncated, "complete"},
                                  {DrillAct::bit_flipped, "complete"},
                                  {DrillAct::nan, "finite"},
                                  {DrillAct::wrong_job, "key"}}) {
    INFO(name_of(act));
    Rehearsal rehearsal(act);
    const auto end = rehearsal.run();
    REQUIRE(end);
    const auto names = rehearsal.broken(*end);
    CHECK(std::find(names.begin(), names.end(), rule) != names.end());
  }
}

TEST_CASE("a drill acts in its first attempts alone where it is told how many") {
  Rehearsal second(DrillAct::nan, 2, 2), third(DrillAct::nan, 2, 3);
  CHECK_FALSE(second.broken(second.run().value()).empty());
  CHECK(third.broken(third.run().value()).empty());
}

TEST_CASE("a leak is refused where no memory limit would stop it") {
  Rehearsal rehearsal(DrillAct::leak);
  const auto end = rehearsal.run();
  REQUIRE_FALSE(end);
  CHECK(end.error().fault == Fault::bad_request);
}
