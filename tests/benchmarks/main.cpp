// fracfarm-timings: Google Benchmark over the parts of a run. Each file of this folder is a family; --benchmark_filter=record runs one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string_view>

#include "common/base/kept_memory.hpp"
#include "tests/benchmarks/families.hpp"
#include "tests/benchmarks/ratios.hpp"

int main(int argc, char** argv) {
  using namespace fracfarm::benchmarks;
  fracfarm::keep_freed_memory();  // as worker and child do
  const bool console = std::none_of(argv, argv + argc, [](std::string_view word) { return word.starts_with("--benchmark_format"); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_steps();
  register_kernels();
  register_fdem_steps();
  RatioReporter ratios;
  if (console)
    benchmark::RunSpecifiedBenchmarks(&ratios);
  else
    benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
