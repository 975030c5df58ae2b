#include "tests/benchmarks/real_run.hpp"

#include "common/base/build_info.hpp"
#include "common/base/hash.hpp"
#include "common/record/writer.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "solver/program/outcome.hpp"

namespace fracfarm::benchmarks {
namespace {

constexpr std::uint64_t campaign_seed = 2026, sample_id = 2;  // about as many steps as the mean of the patterns

RealRun solve_once() {
  RealRun run;
  run.scene = real_scene();
  run.task.scene = canonical_text(run.scene);
  run.task.key = job_key(run.task.scene, build_info().build_id);
  RunResult result = solve(run.scene, {}).value();
  run.summary = summary_of(result);
  run.record = record_of(run.task, run.scene, std::move(result));
  run.bytes = record_bytes(run.record).value();
  run.summary.record_sha256 = sha256_hex(run.bytes);
  return run;
}

}  // namespace

const Scene& real_scene() {
  static const Scene scene = sample_scene({find_material("pbx"), find_load("uniaxial"), CrackSet::orthogonal, campaign_seed, sample_id});
  return scene;
}

const RealRun& real_run() {
  static const RealRun run = solve_once();
  return run;
}

}  // namespace fracfarm::benchmarks
