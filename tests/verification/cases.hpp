// The benchmark rows of the phase field: each case measures something, says what it should be, and how far off it may be.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm::verification {

struct Row {
  std::string what;
  std::string unit;
  double target = 0.0;
  double ours = 0.0;
  double error = 0.0;  // relative to the target, or absolute where the target is 0
  double tolerance = 0.0;
  bool passed = false;
  std::string note;  // empty where there is nothing to say
};

// |ours - target| / |target| <= tolerance, absolute where the target is 0.
Row compare(std::string what, std::string unit, double target, double ours, double tolerance, std::string note = {});

struct Case {
  std::string_view id;
  std::string_view title;
  std::string_view source;  // of the target
  std::vector<Row> (*run)();
};

std::span<const Case> cases();

std::vector<Row> homogeneous_peak();     // PF-1
std::vector<Row> static_profile();       // PF-2
std::vector<Row> discrete_toughness();   // PF-3
std::vector<Row> bounds();               // PF-4
std::vector<Row> dispersion();           // PF-5
std::vector<Row> stability_edge();       // PF-6
std::vector<Row> energy_conservation();  // PF-7
std::vector<Row> impedance();            // PF-8
std::vector<Row> hardening_curve();      // PF-12

}  // namespace fracfarm::verification
