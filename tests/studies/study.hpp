// What the studies share: the dataset's scenes, runs by the solver's door, differences of two runs, and a loop over cases with progress.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solver/simulation.hpp"
#include "solver/solve.hpp"

namespace fracfarm::studies {

struct Choice {
  std::vector<std::string> materials{"pbx", "shale", "tungsten", "aluminum", "steel"};
  std::vector<std::string> loads{"uniaxial"};
  int patterns = 20;          // 1 ... patterns of the seed
  std::uint64_t seed = 2026;  // of the campaign that draws them
  int cells = 127;            // across and up; the dataset's is 127
  double ramp = 0.0;          // s, of the loads; the dataset's is 0
  int jobs = 1;               // threads
};

struct Case {
  std::string material, load;
  int pattern = 1;
};

std::vector<Case> cases_of(const Choice& choice);
Scene scene_of(const Case& one, const Choice& choice);

// How a run ended, and its damage field there.
struct Ending {
  std::string rule;
  std::optional<double> time, stress_drop;  // s
  double peak = 0.0;                        // Pa
  std::vector<float> psi;
  double dt = 0.0;  // s
  double cpu_s = 0.0;
  std::string trouble;  // SOLVER_NUMERIC's evidence
};

Ending ending_of(const Scene& scene);
// The same of a simulation that was changed in a way that no scene can say; no ledger is watched.
Ending ending_of(const Scene& scene, GridSimulation& simulation);
// The damage at the step nearest to `time` (s).
std::vector<float> damage_at(Scene scene, double time);

// 2 |A and B| / (|A| + |B|) of the nodes above the threshold; 1 where there are none.
double dice(const std::vector<float>& a, const std::vector<float>& b, double threshold);
// |a - b| / b; nothing where one of the two is missing.
std::optional<double> apart(const std::optional<double>& a, const std::optional<double>& b);

struct Spread {
  std::size_t count = 0;
  double mean = 0.0, median = 0.0, most = 0.0, least = 0.0;
};
Spread spread_of(std::vector<double> values);

// work(k) for k in 0 ... count - 1 on `jobs` threads, with one line of progress and the time that is left.
void for_all(std::size_t count, int jobs, const std::function<void(std::size_t)>& work);

}  // namespace fracfarm::studies
