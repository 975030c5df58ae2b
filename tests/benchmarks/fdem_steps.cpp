// FDEM steps on a real mesh, for each instruction set and number type that runs here: `fdem_springs` while every joint is a spring,
// `fdem_torn` after the stress has dropped, with damage, contact and its search, `fdem_softened` where a third of the joints are damaged
// (PBX, whose joints soften all over the body). s_per_triangle: CPU seconds per triangle and step; beside it the stages of a step, in wall
// seconds per triangle. `fdem_sample` is what one row of the series costs, `fdem_edge` the step's edge.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>

#include "common/scene/pattern.hpp"
#include "solver/fdem/fdem.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "solver/fdem/solver.hpp"
#include "solver/fdem/stable_step.hpp"
#include "tests/benchmarks/families.hpp"

namespace fracfarm::benchmarks {
namespace {

using namespace fracfarm::fdem;

constexpr int steps_at_once = 20;
// Where a run stands when its steps are timed.
struct Middle {
  const char* material;
  double time;  // s
  auto operator<=>(const Middle&) const = default;
};
const Middle springs{"pbx5", 3e-5}, torn{"pbx5", 1.8e-4}, softened{"pbx", 4e-4};

Scene plates(const char* material) {
  Scene scene;
  scene.method = Method::fdem;
  scene.layers = {{scene.height, *find_material(material)}};
  SideLoad pull;
  pull.to = scene.width, pull.normal_velocity = 1.0, pull.tangential = Tangential::fixed, pull.ramp = 1e-4;
  scene.loads[static_cast<std::size_t>(Side::top)] = scene.loads[static_cast<std::size_t>(Side::bottom)] = {pull};
  scene.cracks = {{0.05, 0.12, 0.08, 0.12}, {0.15, 0.14, 0.19, 0.14}, {0.1, 0.04, 0.1, 0.08}};
  return scene;
}

const TriangleMesh& mesh() {
  static const TriangleMesh made = [] {
    const Scene scene = plates("pbx5");
    return make_mesh({.width = scene.width,
                      .height = scene.height,
                      .element_size = scene.fdem.element_size,
                      .cracks = scene.cracks,
                      .layers = {}})
        ->mesh;
  }();
  return made;
}

// A run in the middle, that can go back there.
template <class Real>
class HalfRun {
 public:
  HalfRun(const Kernels<Real>& kernels, const Middle& middle) : run_(body_of(plates(middle.material), mesh()), settings(), {}, 1, kernels) {
    dt_ = 0.7 * run_.stable_dt();
    bool sound = run_.start(dt_).has_value();
    for (; static_cast<double>(n_) * dt_ < middle.time && sound; ++n_) sound = run_.step(n_, dt_).has_value();
    if (!sound) std::abort();  // the same run is a test of the solver
    run_.save(middle_);
  }
  void go_back() {
    ArchiveReader reader(middle_.bytes());
    if (!run_.load(reader, n_, dt_)) std::abort();
  }
  void go(int steps) {
    for (int n = 0; n < steps; ++n)
      if (!run_.step(n_ + n, dt_)) std::abort();
  }
  Fdem<Real>& run() { return run_; }
  SampleRow sample() const { return run_.sample(n_, dt_); }
  double triangles() const { return static_cast<double>(mesh().triangles.size()); }

 private:
  static FdemSettings settings() {
    FdemSettings settings;
    settings.precision = sizeof(Real) == 8 ? Precision::double_ : Precision::float_;
    return settings;
  }
  Fdem<Real> run_;
  double dt_ = 0.0;
  long long n_ = 0;
  ArchiveWriter middle_;
};

// Google Benchmark calls a function several times to find how often it must be repeated: each run is made once.
template <class Real>
HalfRun<Real>& half_run(const Kernels<Real>* kernels, const Middle& middle) {
  static std::map<std::pair<const Kernels<Real>*, Middle>, std::unique_ptr<HalfRun<Real>>> made;
  std::unique_ptr<HalfRun<Real>>& run = made[{kernels, middle}];
  if (!run) run = std::make_unique<HalfRun<Real>>(*kernels, middle);
  run->go_back();
  return *run;
}

benchmark::Counter per_triangle(double visits) {
  return benchmark::Counter(visits, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Real>
void make_steps(benchmark::State& state, const Kernels<Real>* kernels, const Middle& middle) {
  HalfRun<Real>& half = half_run(kernels, middle);
  const auto before = half.run().stage_seconds();
  for (auto _ : state) {
    state.PauseTiming();
    half.go_back();
    state.ResumeTiming();
    half.go(steps_at_once);
  }
  const double visits = half.triangles() * steps_at_once;
  state.counters["s_per_triangle"] = per_triangle(visits);
  for (const auto& [stage, seconds] : half.run().stage_seconds())
    state.counters[stage] = (seconds - before.at(stage)) / (visits * static_cast<double>(state.iterations()));
  state.counters["followed"] = static_cast<double>(half.run().state().followed.size());
}

template <class Real>
void take_samples(benchmark::State& state, const Kernels<Real>* kernels) {
  const HalfRun<Real>& half = half_run(kernels, springs);
  for (auto _ : state) benchmark::DoNotOptimize(half.sample());
  state.counters["s_per_triangle"] = per_triangle(half.triangles());
}

void find_edge(benchmark::State& state) {
  const Plan plan = make_plan(body_of(plates("pbx5"), mesh()), {});
  for (auto _ : state) benchmark::DoNotOptimize(stable_step(plan));
}

template <class Real>
void register_in() {
  for (const Kernels<Real>* kernels : runnable_kernels<Real>()) {
    const std::string path = std::string(kernels->isa) + (sizeof(Real) == 8 ? "/double" : "/float");
    const auto add = [&](const std::string& name, auto function, auto... more) {
      benchmark::RegisterBenchmark((name + "/" + path).c_str(), function, kernels, more...)->Unit(benchmark::kMicrosecond);
    };
    add("fdem_springs", make_steps<Real>, springs);
    add("fdem_torn", make_steps<Real>, torn);
    if (sizeof(Real) == 4) add("fdem_softened", make_steps<Real>, softened);
    add("fdem_sample", take_samples<Real>);
  }
}

}  // namespace

void register_fdem_steps() {
  register_in<double>();
  register_in<float>();
  benchmark::RegisterBenchmark("fdem_edge", find_edge)->Unit(benchmark::kMillisecond);
}

}  // namespace fracfarm::benchmarks
