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

}  // namespace fracfarm::studies
