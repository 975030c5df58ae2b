#include "tests/verification/cases.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tests/verification/fdem/cases.hpp"
#include "tests/verification/fdem/contact_cases.hpp"
#include "tests/verification/fdem/sample_cases.hpp"
#include "tests/verification/fdem/set_ups.hpp"
#include "tests/verification/set_ups.hpp"

namespace fracfarm::verification {

Row compare(std::string what, std::string unit, double target, double ours, double tolerance, std::string note) {
  const double error = std::abs(ours - target) / (target == 0.0 ? 1.0 : std::abs(target));
  return {std::move(what), std::move(unit), target, ours, error, tolerance, error <= tolerance, std::move(note)};
}

Row between(std::string what, std::string unit, Bounds bounds, double ours, double tolerance, std::string note) {
  const double nearest = ours < bounds.low ? bounds.low : ours > bounds.high ? bounds.high : std::isnan(ours) ? 0.0 : ours;
  Row row = compare(std::move(what), std::move(unit), nearest, ours, tolerance, std::move(note));
  if (bounds.low == bounds.high) return row;
  row.wanted = std::isinf(bounds.high)  ? fmt::format("≥ {:.6g}", bounds.low)
               : std::isinf(bounds.low) ? fmt::format("≤ {:.6g}", bounds.high)
                                        : fmt::format("{:.6g} – {:.6g}", bounds.low, bounds.high);
  return row;
}

Row report(std::string what, std::string unit, double ours, std::string note) {
  Row row = compare(std::move(what), std::move(unit), 0.0, ours, INFINITY, std::move(note));
  row.judged = false, row.passed = true;
  return row;
}

namespace {

// A case that needs no desk.
template <std::vector<Row> (*rows)()>
std::vector<Row> plain(Desk&) {
  return rows();
}

constexpr bool fast = false, slow = true;

constexpr std::array table{
    Case{"PF-1", fast, "homogeneous AT2 peak", "closed form of the homogeneous response", "", plain<homogeneous_peak>},
    Case{"PF-2", fast, "static profile", "psi_k = lambda^|k| of the 5-point scheme", "", plain<static_profile>},
    Case{"PF-3", fast, "discrete toughness", "energy of that profile, closed form", "", plain<discrete_toughness>},
    Case{"PF-4", fast, "bounds and monotony of psi", "M-matrix", "", plain<bounds>},
    Case{"PF-5", fast, "dispersion of plane waves", "sin(omega dt/2) = nu sin(kh/2)", "", plain<dispersion>},
    Case{"PF-5", fast, "dispersion of plane waves, Newmark", "tan(omega dt/2) = nu sin(kh/2)", "", plain<newmark_dispersion>},
    Case{"PF-6", fast, "stability edge", "dt = h / sqrt(c_p^2 + c_s^2)", "", plain<stability_edge>},
    Case{"PF-7", fast, "energy over 1e5 steps", "leapfrog's own invariant", "", plain<energy_conservation>},
    Case{"PF-7", fast, "energy over 1e5 steps, Newmark", "the average-acceleration scheme keeps it", "", plain<newmark_energy>},
    Case{"PF-8", fast, "impedance of a velocity step", "sigma = rho c v", "", plain<impedance>},
    Case{"PF-9", fast, "rotation: the laws", "invariance", "", rotation_of_laws},
    Case{"PF-9", slow, "rotation: a crack turned 0 - 90 degrees", "a curve for each split", rotation_set_up, rotation},
    Case{"PF-10", slow, "closure audit", "a statement for each split", closure_set_up, closure},
    Case{"PF-11", fast, "convergence in space and time", "second-order scheme", convergence_set_up, convergence},
    Case{"PF-12", fast, "hardening curve, secant", "closed form in plane strain", "", plain<hardening_curve>},
    Case{"PF-12", fast, "hardening curve, J2", "closed form of linear isotropic hardening", "", plain<hardening_curve_j2>},
    Case{"PF-20", slow, "notched square, tension", "Miehe et al. (2010) as an open finite element code repeats it", notched_tension_set_up,
         notched_tension},
    Case{"PF-21", slow, "notched square, shear", "Miehe et al. (2010) as an open finite element code repeats it", notched_shear_set_up,
         notched_shear},
    Case{"PF-25", slow, "surfing", "between the two toughnesses of PF-3", surfing_set_up, surfing},
    Case{"PF-30", slow, "branching plate", "Borden et al. (2012) and codes that repeat it", branching_set_up, branching},
    Case{"PF-40", slow, "paper test 1: edge crack", "seed paper, figure 11 (b)", straight_crack_set_up, straight_crack},
    Case{"PF-41", slow, "paper test 2: inclined edge crack", "seed paper, figure 11 (d)", inclined_crack_set_up, inclined_crack},
    Case{"PF-42", slow, "paper test 3: two flaws in compression", "seed paper, figure 11 (f)", two_flaws_set_up, two_flaws},
    Case{"FD-1", fast, "one joint", "Munjiza, Andrews and White (1999); Mahabadi et al. (2012), closed form", one_joint_set_up, one_joint},
    Case{"FD-2", fast, "objectivity", "invariance", objectivity_set_up, objectivity},
    Case{"FD-3", fast, "patch, and waves against the penalty", "joint springs in series with triangles, closed form", joint_chain_set_up,
         joint_chain},
    Case{"FD-4", fast, "step limit", "largest eigenvalue of dt^2 K + 2 dt C is 4", step_limit_set_up, step_limit},
    Case{"FD-5", fast, "spall bar", "d'Alembert's waves with a cohesive joint between two half bars", spall_set_up, spall},
    Case{"FD-6", slow, "double cantilever", "beam theory; Williams (1989); de Moura et al. (2008)", double_cantilever_set_up,
         double_cantilever},
    Case{"FD-7", slow, "end-notched flexure", "beam theory; Russell and Street (1985); de Moura et al. (2006)", end_notched_set_up,
         end_notched},
    Case{"FD-8", fast, "sliding block", "Coulomb", sliding_block_set_up, sliding_block},
    Case{"FD-9", slow, "Hertz", "Hertz (1882), line contact", hertz_set_up, hertz},
    Case{"FD-10", slow, "restitution", "conservation of energy", restitution_set_up, restitution},
    Case{"FD-11", slow, "Brazilian disc", "sigma_t = 2 P / (pi D t); Tang (1994) for the jaws", brazilian_disc_set_up, brazilian_disc},
    Case{"FD-12", slow, "centre crack", "K_I = sqrt(E' G); Tada, Paris and Irwin (1973) for the width", centre_crack_set_up, centre_crack},
    Case{"FD-13", slow, "mesh size", "seed paper, figure 12", mesh_size_set_up, mesh_size},
    Case{"FD-14", slow, "the dataset's loading", "conservation of energy; signals with their answer", paper_loading_set_up, paper_loading},
    Case{"FD-15", fast, "slivers", "refused, repaired or seen", slivers_set_up, slivers},
};

}  // namespace

std::span<const Case> cases() { return table; }

}  // namespace fracfarm::verification
