// How the FDEM cases are set up and what they teach, a paragraph each: it stands on the page VERIFICATION.md.
#pragma once

#include <string_view>

namespace fracfarm::verification {

inline constexpr std::string_view one_joint_set_up =
    "E 20 GPa, ft 5 MPa, fs 20 MPa, G_I 30 J/m², G_II 120 J/m², reference tier. The law alone in double; then a 3 mm square cut along its "
    "diagonal (p = 1 E/h), one half held and the other led away in 2e4 steps: to half of the opening at rupture, back by 0.4 of it, and on "
    "until broken. In mixed mode the target is the closed form along a straight path: p δ0 (δ0/2 + A (δc − δ0)), A the area under the "
    "curve.";

inline constexpr std::string_view objectivity_set_up =
    "30 mm square of shale on the mesher's triangles of 3 mm, reference tier (p = 100 E/h, double). Posed at rest: every stress and joint "
    "force is rounding. Torn apart by a velocity gradient of 8000 /s for 300 steps, past the breaking of many joints: the same body "
    "turned, "
    "shifted or renumbered (nodes, triangles, corners, edges, their directions) ends in the same places.";

inline constexpr std::string_view joint_chain_set_up =
    "Squares of 1 mm in four triangles: a square adds 1 + √2 joints across itself, so the modulus is E / (1 + (1 + √2) E/(p h)); for any "
    "uniform stress there is an exact field, whose forces must vanish. c from the first standing wave of a bar of 60 squares, free ends, "
    "ν = 0. Then a 150 × 30 mm strip between rollers on the mesher's triangles of 3 mm: the fast tier's joints are far softer "
    "than the reference tier's, and its compensated triangles bring back that tier's wave speeds.";

inline constexpr std::string_view step_limit_set_up =
    "36 mm plates on the mesher's triangles of 3 mm, sides free, random velocities, 2000 steps in double without breaking. The edge is the "
    "solver's own number for that mesh, penalty, slivers and viscosity included.";

inline constexpr std::string_view spall_set_up =
    "300 × 1 squares of 1 mm in four triangles between rollers, ν = 0, reference tier without viscosity (it would smear the pulses), all "
    "joints awake. Pulses of 10 MPa that rise over 15 and fall over 130 squares start from both ends; ft is 0.99 of their sum, so each "
    "passes alone. (Flat pulses "
    "break the bar again behind the first crack, where the one that crossed and the rest of the other add up.) The target follows the "
    "joint between two half bars whose faces radiate (δ' = 2 (2ρcv − σ(δ)) / ρc), with the c of FD-3's spring chain; what the joint "
    "carries over before it is broken is taken off the fragment's momentum.";

inline constexpr std::string_view double_cantilever_set_up =
    "A 45 mm beam of two arms 3 mm high, E 10 GPa, ν 0.3, plane strain, squares of 0.75 mm in four triangles tied together but for the "
    "joints of the middle (12 MPa, 250 J/m², p = 10 E/h), crack of 18 mm, right end built in, left ends drawn apart slowly. Release rate "
    "from load and deflection alone, with the crack length that the compliance shows, so that root rotation and zone need no correction.";

inline constexpr std::string_view end_notched_set_up =
    "A 72 mm beam of the same kind on two supports, pressed in the middle, crack of 27 mm from the left support (0.75 of the half span: "
    "stable), joints of 20 MPa and 300 J/m² in shear. Both arms stand on the left support, so that no contact is needed; release rate from "
    "load and deflection alone, from the first broken joint until the zone nears the section that is pressed.";

inline constexpr std::string_view brazilian_disc_set_up =
    "Disc of 50 mm, joints of 1.25 mm on five meshes, E 20 GPa, ft 5 MPa, fs 60 MPa, G_I 3 J/m², G_II 150 J/m², fast tier; smooth jaws "
    "hold arcs of ±8 degrees and close at 0.05 m/s each. The strength that the peak force shows, with the share that the width of a jaw "
    "takes away. The formula is for a brittle disc that is not crushed: with G_I 8 J/m², whose E'G/ft² is an eighth of the disc, and jaws "
    "of ±10 degrees the peak is a quarter higher, and with fs 25 MPa under jaws of ±6 degrees the disc is crushed at 0.7 of it.";

inline constexpr std::string_view centre_crack_set_up =
    "60 × 120 mm, crack of 30 mm, E 20 GPa, ν 0.25, G_I 10 J/m², ends drawn apart at 0.015 m/s each, free sides. The stress borne against "
    "σ √(πa) F = √(E'G), F = (1 − 0.025 α² + 0.06 α⁴) / √cos(πα/2), α = 1/2: 1.186. That is the limit of a small zone: ft grows as h falls "
    "so that E'G/ft² is four elements, a quarter of the crack's half at h = 1 mm, and the error falls with it. Once with joints along the "
    "crack's line alone, so that the path is straight, and once on the mesher's triangles with all joints awake, fast tier. The mesher's "
    "path is crooked: it bears about 6 % more than the straight one, and meshes of one size differ by as much. At h = 1 mm "
    "with a given ft of 7.3 MPa the straight crack bears 11 % less, h = 0.5 mm on the mesher's triangles 8 % less.";

}  // namespace fracfarm::verification
