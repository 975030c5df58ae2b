// Scenes: what comes before the first step, and the criteria that end a run.
#include <benchmark/benchmark.h>

#include "common/base/build_info.hpp"
#include "common/failure/failure.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"
#include "tests/benchmarks/real_run.hpp"

namespace fracfarm::benchmarks {
namespace {

void parse(benchmark::State& state) {
  const std::string text = canonical_text(real_scene());
  for (auto _ : state) benchmark::DoNotOptimize(parse_scene(text));
}

void canonical(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(canonical_text(real_scene()));
}

void key(benchmark::State& state) {
  const std::string text = canonical_text(real_scene());
  for (auto _ : state) benchmark::DoNotOptimize(job_key(text, build_info().build_id));
}

void pattern(benchmark::State& state) {
  std::uint64_t id = 0;
  for (auto _ : state) benchmark::DoNotOptimize(draw_pattern(CrackSet::orthogonal, 2026, ++id));
}

// The field at failure: the longest search, because the crack is through.
void through_crack(benchmark::State& state) {
  const PhaseFieldFrames& field = real_run().record.phase_field;
  const std::vector<double> psi(field.psi_failure.begin(), field.psi_failure.end());
  const FieldView view{psi, static_cast<int>(field.x.size()), static_cast<int>(field.z.size())};
  std::vector<unsigned char> visited;
  for (auto _ : state) benchmark::DoNotOptimize(joins_sides(view, through_crack_threshold, CrackDirection::left_right, visited));
}

void drop(benchmark::State& state) {
  const Series& series = real_run().record.series;
  for (auto _ : state) benchmark::DoNotOptimize(stress_drop(series["step_time"], series["stress_zz"]));
}

void pick(benchmark::State& state) {
  const Series& series = real_run().record.series;
  for (auto _ : state) benchmark::DoNotOptimize(five_step(series["step_time"], series["total_stress"], series["kinetic_energy"]));
}

BENCHMARK(parse)->Name("scene/parse")->Unit(benchmark::kMicrosecond);
BENCHMARK(canonical)->Name("scene/canonical_text")->Unit(benchmark::kMicrosecond);
BENCHMARK(key)->Name("scene/job_key")->Unit(benchmark::kMicrosecond);
BENCHMARK(pattern)->Name("scene/pattern")->Unit(benchmark::kMicrosecond);
BENCHMARK(through_crack)->Name("failure/through_crack")->Unit(benchmark::kMicrosecond);
BENCHMARK(drop)->Name("failure/stress_drop")->Unit(benchmark::kMicrosecond);
BENCHMARK(pick)->Name("failure/five_step")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace fracfarm::benchmarks
