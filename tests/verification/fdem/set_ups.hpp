// How the FDEM cases are set up and what they teach, a paragraph each: it stands on the page VERIFICATION.md.
#pragma once

#include <string_view>

namespace fracfarm::verification {

inline constexpr std::string_view one_joint_set_up =
    "E 20 GPa, ft 5 MPa, fs 20 MPa, G_I 30 J/m², G_II 120 J/m², reference tier. The law alone in double; then a 3 mm square cut along its "
    "diagonal (p = 1 E/h), one half held and the other led away in 2e4 steps: to half of the opening at rupture, back by 0.4 of it, and on "
    "until broken. In mixed mode the target is the closed form along a straight path: p δ0 (δ0/2 + A (δc − δ0)), A the area under the "
    "curve.";

}  // namespace fracfarm::verification
