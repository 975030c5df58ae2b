// How the larger cases are set up and what they show, a paragraph each: it stands on the page VERIFICATION.md.
#pragma once

#include <string_view>

namespace fracfarm::verification {

inline constexpr std::string_view convergence_set_up =
    "A 16 mm square of PBX with w0 = 1 mm fixed, 16² to 128² cells (256² where a grid is compared with the next finer one), dt in "
    "proportion to h, all away from "
    "crack tips. Errors are root mean squares over the nodes of the coarsest grid: of ψ where H is given in closed form for a chosen ψ; of "
    "the displacement of a "
    "standing P and S wave between rollers against the exact solution; and of ψ and u of the same waves strong enough to damage, each grid "
    "against the next finer "
    "one. A sharp crack tip, and the width of a held slot, which is one cell, are first order in h by their nature.";

inline constexpr std::string_view straight_crack_set_up = "";
inline constexpr std::string_view inclined_crack_set_up = "";
inline constexpr std::string_view two_flaws_set_up = "";
inline constexpr std::string_view rotation_set_up = "";
inline constexpr std::string_view closure_set_up = "";
inline constexpr std::string_view surfing_set_up = "";
inline constexpr std::string_view branching_set_up = "";
inline constexpr std::string_view notched_tension_set_up = "";
inline constexpr std::string_view notched_shear_set_up = "";

}  // namespace fracfarm::verification
