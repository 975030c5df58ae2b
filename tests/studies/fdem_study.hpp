// What the FDEM studies share: the dataset's scenes by tier, runs by the solver's door, and what broke of a mesh by when.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/studies/study.hpp"

namespace fracfarm::studies {

struct FdemChoice {
  std::vector<std::string> materials{"shale", "tungsten", "pbx5", "pbx"};
  int patterns = 12;          // 1 ... patterns of the seed
  std::uint64_t seed = 2026;  // of the campaign that draws them
  int jobs = 1;               // threads, one run each
};

std::vector<Case> cases_of(const FdemChoice& choice);
// Uniaxial between plates, run to 1.8 times the stress drop.
Scene fdem_scene(const Case& one, std::uint64_t seed, FdemTier tier = FdemTier::fast);

// How a run ended; nothing but `trouble` where it gave no result.
struct FdemRun {
  std::string trouble;             // why its mesh was refused, or SOLVER_NUMERIC's evidence
  std::vector<std::string> notes;  // each of them an alarm, after which the run was begun again
  std::string rule;
  std::optional<double> drop10, five_step;  // s
  double peak = 0.0;                        // Pa
  double last_time = 0.0, dt = 0.0;         // s
  double residual = 0.0;                    // of the energy ledger, over the largest work
  double cpu_s = 0.0;
  Series series;
  MeshLayout layout;
  std::vector<float> damage_initial;
};

FdemRun run_fdem(const Scene& scene, const RunControl& control = {});

// Edges that were whole at the start and broken by `time` (s).
struct Broken {
  std::size_t edges = 0;
  double length = 0.0;  // m
};
Broken broken_by(const FdemRun& run, double time);

// The damage on edges of the same instant: 2 on initial cracks, 1 on broken edges, else 0.
std::vector<float> broken_field(const FdemRun& run, double time);

// Shares of the broken length by the direction of the edges: bin k holds 180 / direction_bins degrees around k times that, 0 is along x.
inline constexpr std::size_t direction_bins = 6;
std::array<double, direction_bins> directions_by(const FdemRun& run, double time);

// Pa: rise of the mean vertical stress with the mean strain that the plates bring, between 20 and 50 % of the peak.
double stiffness_of(const FdemRun& run, const Scene& scene);

// |a - b| / b; 0 where both are 0.
double share_apart(double a, double b);

// What parts a run from the one that judges it, all relative; nothing but `trouble` where one of the two has no stress drop. Broken edges
// are counted up to the earlier of both ends. A stress that swings about 10 % of its peak makes drop10 jump by a whole swing; so beside it
// stand the same instants at 11 and 9 %, and the distance from 10 % (of the peak) to the nearest threshold at which the judge's drop comes
// within `near` of the run's drop10.
struct RunDifference {
  std::string trouble;
  double peak = 0.0, drop10 = 0.0, drop11 = 0.0, drop9 = 0.0, threshold = 0.0, edges = 0.0, length = 0.0;
};
RunDifference difference(const FdemRun& run, const FdemRun& judge, double near);

std::string mean_most(const Spread& s, int digits = 2);  // "0.31 / 0.84", in %; "-" of nothing

}  // namespace fracfarm::studies
