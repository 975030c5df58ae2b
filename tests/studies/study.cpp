#include "tests/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <thread>

#include "common/base/clock.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/failure/new_crack.hpp"
#include "common/scene/pattern.hpp"
#include "solver/through_crack_watch.hpp"

namespace fracfarm::studies {

std::vector<Case> cases_of(const Choice& choice) {
  std::vector<Case> cases;
  for (const std::string& material : choice.materials)
    for (const std::string& load : choice.loads)
      for (int pattern = 1; pattern <= choice.patterns; ++pattern) cases.push_back({material, load, pattern});
  return cases;
}

Scene scene_of(const Case& one, const Choice& choice) {
  Scene scene = sample_scene(
      {find_material(one.material), find_load(one.load), CrackSet::orthogonal, choice.seed, static_cast<std::uint64_t>(one.pattern)});
  scene.phase_field.cells_x = scene.phase_field.cells_z = choice.cells;
  scene.frame_interval = scene.horizon;
  for (auto& side : scene.loads)
    for (SideLoad& part : side) part.ramp = choice.ramp;
  return scene;
}

Ending ending_of(const Scene& scene) {
  Result<RunResult> result = solve(scene, {});
  Ending ending;
  if (!result) {
    ending.rule = "diverged", ending.trouble = result.error().message;
    return ending;
  }
  ending.rule = result->judgement.rule;
  ending.time = result->judgement.time_to_failure;
  for (const FailureTime& time : result->times)
    if (time.rule == "stress_drop") ending.stress_drop = time.time;
  ending.peak = result->peak_stress;
  ending.psi = std::move(result->damage_failure);
  ending.dt = result->dt;
  ending.cpu_s = result->cpu_s;
  return ending;
}

Ending ending_of(const Scene& scene, GridSimulation& simulation) {
  Ending ending;
  ending.dt = scene.phase_field.cfl * simulation.stable_dt();
  ThroughCrackWatch watch(scene, simulation);
  const double start_s = thread_cpu_s();
  Result<void> moved = simulation.start(ending.dt);
  const std::vector<float> psi_initial = simulation.stored_damage();
  long long n = 0;
  for (; moved && !watch.through_crack() && static_cast<double>(n) * ending.dt < scene.horizon; ++n) {
    moved = simulation.step(n, ending.dt);
    const double time = static_cast<double>(n + 1) * ending.dt, stress = simulation.mean_stress_zz();
    ending.peak = std::max(ending.peak, stress);
    if (watch.wants_row(stress)) ending.stress_drop = time;
    watch.note_stress(stress);
    if (watch.psi_dropped().empty()) ending.stress_drop.reset();
    watch.after_step(time);
  }
  ending.cpu_s = thread_cpu_s() - start_s;
  if (!moved) ending.rule = "diverged", ending.trouble = moved.error().message;
  if (!has_new_crack(watch.psi_dropped(), psi_initial)) ending.stress_drop.reset();
  const bool through = watch.through_crack().has_value();
  ending.time = through ? watch.through_crack() : ending.stress_drop;
  ending.rule = !moved ? "diverged" : through ? "through_crack" : ending.stress_drop ? "stress_drop" : "horizon";
  ending.psi = through ? watch.psi_through() : ending.stress_drop ? watch.psi_dropped() : simulation.stored_damage();
  return ending;
}

std::vector<float> damage_at(Scene scene, double time) {
  scene.stop = Stop::horizon;
  scene.horizon = scene.frame_interval = time;
  Result<RunResult> result = solve(scene, {});
  return result && result->frames.size() > 1 ? std::move(result->frames[1].damage) : std::vector<float>{};
}

double dice(const std::vector<float>& a, const std::vector<float>& b, double threshold) {
  if (a.size() != b.size()) return 0.0;
  std::size_t both = 0, sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const bool in_a = static_cast<double>(a[n]) > threshold, in_b = static_cast<double>(b[n]) > threshold;
    both += in_a && in_b;
    sum += static_cast<std::size_t>(in_a) + static_cast<std::size_t>(in_b);
  }
  return sum > 0 ? 2.0 * static_cast<double>(both) / static_cast<double>(sum) : 1.0;
}

std::optional<double> apart(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b || *b == 0.0) return std::nullopt;
  return std::abs(*a - *b) / std::abs(*b);
}

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {n, std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n), 0.5 * (values[(n - 1) / 2] + values[n / 2]),
          values.back(), values.front()};
}

void for_all(std::size_t count, int jobs, const std::function<void(std::size_t)>& work) {
  SystemClock clock;
  const double start_s = clock.monotonic_s();
  std::atomic<std::size_t> next = 0;
  std::mutex told;
  std::size_t done = 0;
  ProgressLine line;
  const auto serve = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      work(k);
      const std::lock_guard lock(told);
      const double elapsed = clock.monotonic_s() - start_s;
      ++done;
      if (elapsed > 2.0)
        line.show(fmt::format("{} of {} cases, {} left", done, count,
                              duration_text(elapsed / static_cast<double>(done) * static_cast<double>(count - done))));
    }
  };
  std::vector<std::jthread> threads;
  for (int k = 1; k < jobs; ++k) threads.emplace_back(serve);
  serve();
}

}  // namespace fracfarm::studies
