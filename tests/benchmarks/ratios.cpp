#include "tests/benchmarks/ratios.hpp"

#include <unistd.h>

#include <cstdlib>
#include <iomanip>

namespace fracfarm::benchmarks {
namespace {

// The name with one of its words changed; empty where it has not that word.
std::string with(const std::string& name, const std::string& word, const std::string& instead) {
  const std::size_t at = name.find("/" + word);
  return at == std::string::npos ? "" : name.substr(0, at + 1) + instead + name.substr(at + 1 + word.size());
}

}  // namespace

RatioReporter::RatioReporter()
    : benchmark::ConsoleReporter(::isatty(STDOUT_FILENO) && !std::getenv("NO_COLOR") ? OO_ColorTabular : OO_Tabular) {}

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  benchmark::ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.error_occurred || run.run_type != Run::RT_Iteration || run.iterations == 0) continue;
    names_.push_back(run.benchmark_name());
    cpu_s_[names_.back()] = run.cpu_accumulated_time / static_cast<double>(run.iterations);
  }
}

void RatioReporter::Finalize() {
  std::ostream& out = GetOutputStream();
  const auto say = [&](const std::string& slow, const std::string& fast) {
    if (!cpu_s_.contains(slow) || !cpu_s_.contains(fast)) return;
    out << std::left << std::setw(34) << slow << " takes " << std::fixed << std::setprecision(2) << cpu_s_[slow] / cpu_s_[fast] << " times "
        << fast << "\n";
  };
  for (const std::string& name : names_) {
    say(name, with(name, "double", "float"));
    for (const char* lower : {"v3", "baseline"}) say(name, with(name, lower, "v4"));
    if (!cpu_s_.contains(with(name, "baseline", "v4"))) say(name, with(name, "baseline", "v3"));
  }
}

}  // namespace fracfarm::benchmarks
