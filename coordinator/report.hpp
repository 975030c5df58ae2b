// The campaign as one self-contained HTML page: picture grid, time-to-failure by material, tables. Pure: rows in, text out; no script, no
// links outside.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/failure/failure.hpp"

namespace fracfarm {

struct ReportRun {
  std::uint64_t job = 0;
  std::string material;
  std::string load;
  std::string pattern;  // orthogonal 17, oblique 3
  Verdict verdict = Verdict::censored;
  std::optional<double> time_to_failure;  // s
  std::string rule;
  double peak_stress = 0.0;  // Pa
  long long steps = 0;
  double cpu_s = 0.0;
};

// What is drawn of a run; only the first patterns have pictures.
struct ReportPicture {
  std::string initial_png;  // bytes
  std::string failure_png;
  std::vector<std::pair<double, double>> stress;  // s, Pa: thinned mean stress
};

struct ReportPage {
  std::string title;
  std::string generated;  // UTC, in words
  std::string build_id;
  std::map<std::string, std::uint64_t> counts;      // by state, lower case
  std::map<std::string, std::uint64_t> faults;      // by class
  std::vector<ReportRun> runs;                      // DONE jobs by id
  std::map<std::uint64_t, ReportPicture> pictures;  // by job
  std::uint64_t runs_left_out = 0;                  // DONE jobs beyond the page's limit
};

inline constexpr std::size_t report_max_runs = 2000;   // rows of the page's table
inline constexpr std::size_t report_max_patterns = 8;  // columns of a picture grid

std::string report_html(const ReportPage& page);

}  // namespace fracfarm
