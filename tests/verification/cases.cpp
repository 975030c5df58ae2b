#include "tests/verification/cases.hpp"

#include <array>
#include <cmath>

namespace fracfarm::verification {

Row compare(std::string what, std::string unit, double target, double ours, double tolerance, std::string note) {
  const double error = std::abs(ours - target) / (target == 0.0 ? 1.0 : std::abs(target));
  return {std::move(what), std::move(unit), target, ours, error, tolerance, error <= tolerance, std::move(note)};
}

namespace {

constexpr std::array<Case, 9> table{{
    {"PF-1", "homogeneous AT2 peak", "closed form of the homogeneous response", homogeneous_peak},
    {"PF-2", "static profile", "psi_k = lambda^|k| of the 5-point scheme", static_profile},
    {"PF-3", "discrete toughness", "energy of that profile, closed form", discrete_toughness},
    {"PF-4", "bounds and monotony of psi", "M-matrix", bounds},
    {"PF-5", "dispersion of plane waves", "sin(omega dt/2) = nu sin(kh/2)", dispersion},
    {"PF-6", "stability edge", "dt = h / sqrt(c_p^2 + c_s^2)", stability_edge},
    {"PF-7", "energy over 1e5 steps", "leapfrog's own invariant", energy_conservation},
    {"PF-8", "impedance of a velocity step", "sigma = rho c v", impedance},
    {"PF-12", "hardening curve, secant", "closed form in plane strain", hardening_curve},
}};

}  // namespace

std::span<const Case> cases() { return table; }

}  // namespace fracfarm::verification
