// The studies, each a question with its figures: run by fracfarm-study.
#pragma once

#include "tests/studies/fdem_study.hpp"
#include "tests/studies/study.hpp"

namespace fracfarm::studies {

// Is the scheme second order in time where it matters: do coarser steps give the reference step's time to failure and cracks?
struct TimeStepQuestion {
  Choice choice;
  std::vector<double> cfl{0.9, 0.45};
  double reference = 0.225;
  double time_limit = 0.01;  // of |dt_f| / t_f
  double dice_limit = 0.98;  // of psi > 0.5 at failure
  bool json = false;
};
// Prints the table, every pattern that misses with what its miss looks like, and the verdict; 0 where every pattern is within both limits.
int time_step(const TimeStepQuestion& question);

// What each rule of "no more than needed" costs in accuracy and saves in time.
struct RulesQuestion {
  Choice choice;
  std::vector<std::string> rules;  // names; empty: all
  bool json = false;
};
int rules(const RulesQuestion& question);
std::vector<std::string> rule_names();

// How far the cheaper tiers of FDEM are from the reference tier, and how much cheaper.
struct FdemTiersQuestion {
  FdemChoice choice;
  double peak_limit = 0.015, drop_limit = 0.03, edges_limit = 0.12;  // of the fast tier
  bool json = false;
};
// 0 where every pattern's fast run is within all three limits.
int fdem_tiers(const FdemTiersQuestion& question);

// How far FDEM's reference tier is from itself: what a comparison with it cannot go below.
struct FdemFloorQuestion {
  FdemChoice choice;
  std::vector<int> only;  // patterns; empty: 1 ... as the choice says
  double near = 0.03;     // of drop10: what counts as the same instant
  bool json = false;
};
int fdem_floor(const FdemFloorQuestion& question);

// What each rule of FDEM costs in accuracy and saves in time.
struct FdemRulesQuestion {
  FdemChoice choice;
  bool json = false;
};
int fdem_rules(const FdemRulesQuestion& question);

// What running on until the five-step pick exists costs, and whether it is the pick of a run to the horizon.
struct FdemPickQuestion {
  FdemChoice choice;
  double reach = 8.0;  // of drop10: how far the run goes on whose pick is the last word
  bool json = false;
};
int fdem_pick(const FdemPickQuestion& question);

// Twice, once and half the element size on several meshes each.
struct FdemMeshQuestion {
  FdemChoice choice;
  std::array<double, 3> sizes{0.006, 0.003, 0.0015};  // m; the second is what the others are compared with
  int meshes = 3;                                     // seeds of each
  double bulk_limit = 0.10;                           // of stiffness and peak
  bool json = false;
};
// 0 where stiffness and peak of every pattern are within the limit.
int fdem_mesh(const FdemMeshQuestion& question);

// The body's answer on our meshes and on those of the program gmsh, which must be installed.
struct FdemGmshQuestion {
  FdemChoice choice;
  std::string folder;        // for gmsh's files; empty: a temporary one
  double bulk_limit = 0.02;  // of the mean over patterns of stiffness, peak and drop10
  bool json = false;
};
// 0 where the three means of each material are within the limit.
int fdem_gmsh(const FdemGmshQuestion& question);

// The edge of the step that is predicted against the one that is observed, and what runs past it do.
struct FdemStabilityQuestion {
  FdemChoice choice;
  std::vector<double> past{1.02, 1.1, 1.3};  // dt of runs past the edge, of the edge
  double past_horizon = 6e-5;                // s, of those runs
  std::string picture;                       // a PNG file; empty: none
  bool json = false;
};
// 0 where every observed edge is within 5 % of the predicted one.
int fdem_stability(const FdemStabilityQuestion& question);

// Where FDEM and the phase field part ways on the same patterns.
struct FdemMethodsQuestion {
  FdemChoice choice;
  std::string picture;  // a PNG file of one pattern in every material; empty: none
  int picture_pattern = 1;
  bool json = false;
};
int fdem_methods(const FdemMethodsQuestion& question);

}  // namespace fracfarm::studies
