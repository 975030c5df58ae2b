// The benchmark rows, of the phase field here and of FDEM in fdem/: each case measures something, says what it should be, and how far off it may be.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm::verification {

class Desk;

struct Row {
  std::string what;
  std::string unit;
  double target = 0.0;
  double ours = 0.0;
  double error = 0.0;  // relative to the target, or absolute where the target is 0; of a range: the distance outside it
  double tolerance = 0.0;
  bool passed = false;
  std::string note = {};    // empty where there is nothing to say
  std::string wanted = {};  // how a target that is no single number reads
  bool judged = true;       // false: a figure that is reported and has no target
};

// |ours - target| / |target| <= tolerance, absolute where the target is 0.
Row compare(std::string what, std::string unit, double target, double ours, double tolerance, std::string note = {});

struct Bounds {
  double low, high;  // an infinite end is open
};
// low (1 - tolerance) <= ours <= high (1 + tolerance).
Row between(std::string what, std::string unit, Bounds bounds, double ours, double tolerance, std::string note = {});

// A figure without a target.
Row report(std::string what, std::string unit, double ours, std::string note = {});

struct Case {
  std::string_view id;
  bool is_long;  // left out unless asked for
  std::string_view title;
  std::string_view source;  // of the target
  std::string_view set_up;  // empty where title and rows say it all
  std::vector<Row> (*run)(Desk&);
};

std::span<const Case> cases();

std::vector<Row> homogeneous_peak();    // PF-1
std::vector<Row> static_profile();      // PF-2
std::vector<Row> discrete_toughness();  // PF-3
std::vector<Row> bounds();              // PF-4
std::vector<Row> dispersion();          // PF-5
std::vector<Row> newmark_dispersion();
std::vector<Row> stability_edge();       // PF-6
std::vector<Row> energy_conservation();  // PF-7
std::vector<Row> newmark_energy();
std::vector<Row> impedance();              // PF-8
std::vector<Row> rotation_of_laws(Desk&);  // PF-9
std::vector<Row> rotation(Desk&);
std::vector<Row> closure(Desk&);      // PF-10
std::vector<Row> convergence(Desk&);  // PF-11
std::vector<Row> hardening_curve();   // PF-12
std::vector<Row> hardening_curve_j2();
std::vector<Row> notched_tension(Desk&);  // PF-20
std::vector<Row> notched_shear(Desk&);    // PF-21
std::vector<Row> surfing(Desk&);          // PF-25
std::vector<Row> branching(Desk&);        // PF-30
std::vector<Row> straight_crack(Desk&);   // PF-40
std::vector<Row> inclined_crack(Desk&);   // PF-41
std::vector<Row> two_flaws(Desk&);        // PF-42

}  // namespace fracfarm::verification
