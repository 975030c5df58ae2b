#include "tests/studies/fdem_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/scene/pattern.hpp"

namespace fracfarm::studies {

std::vector<Case> cases_of(const FdemChoice& choice) {
  Choice all;
  all.materials = choice.materials, all.patterns = choice.patterns, all.seed = choice.seed;
  return cases_of(all);
}

Scene fdem_scene(const Case& one, std::uint64_t seed, FdemTier tier) {
  Scene scene = sample_scene({find_material(one.material), find_load(one.load), CrackSet::orthogonal, seed,
                              static_cast<std::uint64_t>(one.pattern), Method::fdem});
  scene.frame_interval = scene.horizon;
  scene.stop = Stop::drop10;
  scene.fdem.tier = tier;
  if (tier == FdemTier::screening) scene.fdem.element_size *= 2.0;
  return scene;
}

FdemRun run_fdem(const Scene& scene, const RunControl& control) {
  FdemRun run;
  Result<RunResult> result = solve(scene, control);
  if (!result || result->judgement.verdict == Verdict::rejected) {
    run.trouble = result ? "refused: " + result->judgement.rule : result.error().message;
    return run;
  }
  run.notes = result->notes, run.rule = result->judgement.rule;
  for (const FailureTime& time : result->times) (time.rule == "drop10" ? run.drop10 : run.five_step) = time.time;
  run.peak = result->peak_stress, run.dt = result->dt, run.residual = result->energy_residual, run.cpu_s = result->cpu_s;
  run.last_time = static_cast<double>(result->steps) * result->dt;
  run.series = std::move(result->series);
  run.layout = std::get<MeshLayout>(std::move(result->layout));
  run.damage_initial = std::move(result->damage_initial);
  return run;
}

Broken broken_by(const FdemRun& run, double time) {
  Broken broken;
  const TriangleMesh& mesh = run.layout.mesh;
  for (std::size_t edge = 0; edge < mesh.edge_nodes.size(); ++edge) {
    if (!(run.layout.break_time[edge] <= time)) continue;
    const auto &a = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][0])],
               &b = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][1])];
    ++broken.edges;
    broken.length += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return broken;
}

double share_apart(double a, double b) { return a == b ? 0.0 : std::abs(a - b) / std::abs(b); }

std::string mean_most(const Spread& s, int digits) {
  return s.count ? fmt::format("{:.{}f} / {:.{}f}", 100.0 * s.mean, digits, 100.0 * s.most, digits) : "-";
}

}  // namespace fracfarm::studies
