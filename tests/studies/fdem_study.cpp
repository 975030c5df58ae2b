#include "tests/studies/fdem_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/failure/failure.hpp"
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
  scene.fdem = defaults_of(tier);
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

namespace {

// see(dx, dz) of every edge that broke by then.
template <class See>
void each_broken(const FdemRun& run, double time, See see) {
  const TriangleMesh& mesh = run.layout.mesh;
  for (std::size_t edge = 0; edge < mesh.edge_nodes.size(); ++edge) {
    if (!(run.layout.break_time[edge] <= time)) continue;
    const auto &a = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][0])],
               &b = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[edge][1])];
    see(b[0] - a[0], b[1] - a[1]);
  }
}

// m, of one plate.
double pulled_by(const SideLoad& load, double time) {
  const double v = load.normal_velocity.value_or(0.0);
  return time < load.ramp ? 0.5 * v * time * time / load.ramp : v * (time - 0.5 * load.ramp);
}

}  // namespace

Broken broken_by(const FdemRun& run, double time) {
  Broken broken;
  each_broken(run, time, [&](double dx, double dz) { ++broken.edges, broken.length += std::hypot(dx, dz); });
  return broken;
}

std::vector<float> broken_field(const FdemRun& run, double time) {
  const TriangleMesh& mesh = run.layout.mesh;
  std::vector<float> field(mesh.edge_nodes.size(), 0.0F);
  for (std::size_t edge = 0; edge < field.size(); ++edge)
    field[edge] = mesh.edge_kind[edge] == EdgeKind::crack ? 2.0F : run.layout.break_time[edge] <= time ? 1.0F : 0.0F;
  return field;
}

std::array<double, direction_bins> directions_by(const FdemRun& run, double time) {
  std::array<double, direction_bins> shares{};
  each_broken(run, time, [&](double dx, double dz) {
    const double turns = std::atan2(dz, dx) / M_PI * static_cast<double>(direction_bins);
    const long bin = std::lround(turns + 2.0 * static_cast<double>(direction_bins)) % static_cast<long>(direction_bins);
    shares[static_cast<std::size_t>(bin)] += std::hypot(dx, dz);
  });
  const double all = broken_by(run, time).length;
  for (double& share : shares) share = all > 0.0 ? share / all : 0.0;
  return shares;
}

double stiffness_of(const FdemRun& run, const Scene& scene) {
  double count = 0.0, e = 0.0, s = 0.0, ee = 0.0, es = 0.0;
  for (std::size_t row = 0; row < run.series.rows(); ++row) {
    const double time = run.series["step_time"][row], stress = run.series["stress_zz"][row];
    if (stress > 0.5 * run.peak) break;
    if (stress < 0.2 * run.peak) continue;
    const double strain = (pulled_by(scene.on(Side::top).front(), time) + pulled_by(scene.on(Side::bottom).front(), time)) / scene.height;
    count += 1.0, e += strain, s += stress, ee += strain * strain, es += strain * stress;
  }
  return (count * es - e * s) / (count * ee - e * e);
}

double share_apart(double a, double b) { return a == b ? 0.0 : std::abs(a - b) / std::abs(b); }

namespace {

// Of the time at which the mean stress falls below a share of its peak; 1 where one of the two never does.
double drop_apart(const FdemRun& run, const FdemRun& judge, double fraction) {
  const auto drop = [fraction](const FdemRun& r) { return stress_drop(r.series["step_time"], r.series["stress_zz"], fraction); };
  const auto ours = drop(run), theirs = drop(judge);
  return ours && theirs ? share_apart(*ours, *theirs) : 1.0;
}

// Each row at which the stress is lower than ever since its peak is the drop for all thresholds between it and the lowest before.
double threshold_apart(const FdemRun& run, const FdemRun& judge, double near) {
  const std::span<const double> time = judge.series["step_time"], stress = judge.series["stress_zz"];
  const auto peak = std::max_element(stress.begin(), stress.end());
  double nearest = 1.0, low = 1.0;
  for (std::size_t row = static_cast<std::size_t>(peak - stress.begin()); row < stress.size(); ++row) {
    const double share = stress[row] / *peak;
    if (share >= low) continue;
    if (share_apart(*run.drop10, time[row]) <= near)
      nearest = std::min(nearest, std::max({0.0, share - stress_drop_fraction, stress_drop_fraction - low}));
    low = share;
  }
  return nearest;
}

}  // namespace

RunDifference difference(const FdemRun& run, const FdemRun& judge, double near) {
  RunDifference a;
  a.trouble = run.trouble + judge.trouble;
  if (a.trouble.empty() && (!run.drop10 || !judge.drop10)) a.trouble = "no stress drop";
  if (!a.trouble.empty()) return a;
  a.peak = share_apart(run.peak, judge.peak), a.drop10 = share_apart(*run.drop10, *judge.drop10);
  a.drop11 = drop_apart(run, judge, 0.11), a.drop9 = drop_apart(run, judge, 0.09), a.threshold = threshold_apart(run, judge, near);
  const double common = std::min(run.last_time, judge.last_time);
  const Broken ours = broken_by(run, common), theirs = broken_by(judge, common);
  a.edges = share_apart(static_cast<double>(ours.edges), static_cast<double>(theirs.edges));
  a.length = share_apart(ours.length, theirs.length);
  return a;
}

std::string mean_most(const Spread& s, int digits) {
  return s.count ? fmt::format("{:.{}f} / {:.{}f}", 100.0 * s.mean, digits, 100.0 * s.most, digits) : "-";
}

}  // namespace fracfarm::studies
