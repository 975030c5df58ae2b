// fracfarm-bench: Google Benchmark over the parts of a run. Each file of this folder is a family.
#include <benchmark/benchmark.h>

#include "common/base/kept_memory.hpp"

int main(int argc, char** argv) {
  fracfarm::keep_freed_memory();  // as worker and child do
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
