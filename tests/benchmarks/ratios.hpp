// The console's table, then ratios between benchmarks of the same run: double over float, and every instruction set over the best one.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace fracfarm::benchmarks {

class RatioReporter : public benchmark::ConsoleReporter {
 public:
  RatioReporter();  // colour only on a terminal
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, double> cpu_s_;  // by name, per iteration
  std::vector<std::string> names_;       // in the order in which they ran
};

}  // namespace fracfarm::benchmarks
