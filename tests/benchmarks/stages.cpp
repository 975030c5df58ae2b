// The phase-field step on a real state: a run stopped in the middle, with cracks under way. Every kernel of the table alone over all rows,
// then whole steps; for each instruction set and number type that runs here. s_per_node: CPU seconds per node and
// call, or node and step; beside it the stages of a step, in wall seconds per node.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "solver/phasefield/phase_field.hpp"
#include "tests/benchmarks/families.hpp"
#include "tests/benchmarks/real_run.hpp"

namespace fracfarm::benchmarks {
namespace {

using namespace fracfarm::phasefield;

constexpr int steps_before = 400;  // of about 750: damage grows along several cracks
constexpr int steps_at_once = 50;  // then the state goes back to where it was

template <class Real>
constexpr const char* precision = sizeof(Real) == 8 ? "double" : "float";

// A run in the middle, that can go back there.
template <class Real>
class HalfRun {
 public:
  explicit HalfRun(const Kernels<Real>& kernels) : run_(real_scene(), kernels), dt_(0.9 * run_.stable_dt()) {
    bool sound = run_.start(dt_).has_value();
    for (int n = 0; n < steps_before && sound; ++n) sound = run_.step(n, dt_).has_value();
    if (!sound) std::abort();  // the same run is a test of the solver
    run_.save(middle_);
  }
  void go_back() {
    ArchiveReader reader(middle_.bytes());
    if (!run_.load(reader, steps_before, dt_)) std::abort();
  }
  PhaseField<Real>& run() { return run_; }
  double dt() const { return dt_; }
  double nodes() const { return static_cast<double>(run_.columns()) * run_.rows(); }

 private:
  PhaseField<Real> run_;
  double dt_;
  ArchiveWriter middle_;
};

// Google Benchmark calls a function several times to find how often it must be repeated: each run is made once.
template <class Real>
HalfRun<Real>& half_run(const Kernels<Real>* kernels) {
  static std::map<const Kernels<Real>*, std::unique_ptr<HalfRun<Real>>> made;
  std::unique_ptr<HalfRun<Real>>& run = made[kernels];
  if (!run) run = std::make_unique<HalfRun<Real>>(*kernels);
  run->go_back();
  return *run;
}

benchmark::Counter per_node(double visits) {
  return benchmark::Counter(visits, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// What a kernel gets: rows of a view, and copies of psi that it may spoil.
template <class Real>
struct Rows {
  View<Real> view;
  Field<Real> psi, other;
  const Kernels<Real>& kernels;
  std::size_t origin;

  const Real* in() const { return psi.data() + origin; }
  Real* out() { return other.data() + origin; }
};

template <class Real>
using Visit = void (*)(Rows<Real>&, int j);

// Steps of zero length, so that a state stays where it is however often it is visited.
template <class Real>
struct KernelRow {
  const char* name;
  Visit<Real> visit;
};

template <class Real>
constexpr KernelRow<Real> kernel_rows[] = {
    {"drift", [](Rows<Real>& r, int j) { r.kernels.drift(r.view, j, Real(0)); }},
    {"history", [](Rows<Real>& r, int j) { benchmark::DoNotOptimize(r.kernels.history(r.view, j)); }},
    {"guess", [](Rows<Real>& r, int j) { r.kernels.guess(r.view, j, r.in(), r.out()); }},
    {"sweep", [](Rows<Real>& r, int j) { benchmark::DoNotOptimize(r.kernels.sweep(r.view, j, r.in(), r.out(), Real(1.1), false)); }},
    {"settle", [](Rows<Real>& r, int j) { benchmark::DoNotOptimize(r.kernels.settle(r.view, j, r.out())); }},
    {"degrade",
     [](Rows<Real>& r, int j) {
       Sums s;
       r.kernels.degrade(r.view, j, j + 1, r.in(), r.in(), s);
     }},
    {"force",
     [](Rows<Real>& r, int j) {
       Sums s;
       r.kernels.force(r.view, j, j + 1, s);
     }},
    {"kick",
     [](Rows<Real>& r, int j) {
       const auto amid = [&](int row) { return r.view.node_rows[row].amid; };
       if (j > 0 && amid(j) && amid(j - 1) && j % strip_rows != 1) return;  // in the strip of the row before
       int end = j + 1;
       while (end < r.view.rows && amid(j) && amid(end) && end % strip_rows != 1) ++end;
       Sums s;
       r.kernels.kick(r.view, j, end, Real(0), s);
     }},
    {"surface",
     [](Rows<Real>& r, int j) {
       SurfaceParts s;
       if (j % 8 == 0) r.kernels.surface(r.view, j, std::min(j + 8, r.view.rows), r.in(), s);
     }},
};

template <class Real>
void visit_rows(benchmark::State& state, const Kernels<Real>* kernels, Visit<Real> visit) {
  HalfRun<Real>& half = half_run(kernels);
  PhaseField<Real>& run = half.run();
  Rows<Real> rows{view(run.model(), run.state(), run.scratch()), run.state().psi, run.state().psi, *kernels, run.model().grid.origin()};
  for (auto _ : state)
    for (int j = 0; j < rows.view.rows; ++j) visit(rows, j);
  state.counters["s_per_node"] = per_node(half.nodes());
}

template <class Real>
void make_steps(benchmark::State& state, const Kernels<Real>* kernels) {
  HalfRun<Real>& half = half_run(kernels);
  const auto before = half.run().stage_seconds();
  for (auto _ : state) {
    state.PauseTiming();
    half.go_back();
    state.ResumeTiming();
    for (int n = 0; n < steps_at_once; ++n)
      if (!half.run().step(steps_before + n, half.dt())) state.SkipWithError("the run failed");
  }
  const double visits = half.nodes() * steps_at_once;
  state.counters["s_per_node"] = per_node(visits);
  for (const auto& [stage, seconds] : half.run().stage_seconds())
    state.counters[stage] = (seconds - before.at(stage)) / (visits * static_cast<double>(state.iterations()));
}

template <class Real>
void register_kernels_in() {
  for (const Kernels<Real>* kernels : runnable_kernels<Real>())
    for (const KernelRow<Real>& row : kernel_rows<Real>)
      benchmark::RegisterBenchmark(("kernel/" + std::string(row.name) + "/" + std::string(kernels->isa) + "/" + precision<Real>).c_str(),
                                   visit_rows<Real>, kernels, row.visit);
}

template <class Real>
void register_steps_in() {
  for (const Kernels<Real>* kernels : runnable_kernels<Real>())
    benchmark::RegisterBenchmark(("steps/" + std::string(kernels->isa) + "/" + precision<Real>).c_str(), make_steps<Real>, kernels)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_kernels() {
  register_kernels_in<double>();
  register_kernels_in<float>();
}

void register_steps() {
  register_steps_in<double>();
  register_steps_in<float>();
}

}  // namespace fracfarm::benchmarks
