// The benchmark rows of FDEM's contact, and how they are set up, for the page VERIFICATION.md.
#pragma once

#include <string_view>

#include "tests/verification/cases.hpp"

namespace fracfarm::verification {

std::vector<Row> sliding_block(Desk&);  // FD-8
std::vector<Row> hertz(Desk&);          // FD-9
std::vector<Row> restitution(Desk&);    // FD-10

inline constexpr std::string_view sliding_block_set_up =
    "An elastic block of 24 × 3 mm on an elastic table (E 20 GPa, 3 mm, double, penalty 1 E, friction 0.6), its weight of 1e5 m/s² put on "
    "within 0.1 ms. Thrown at 25 m/s, it slides over two sides of triangles and stops; what neither friction nor viscosity took rings in "
    "the bodies. From rest, it bears 0.95 of µ N along the table without creep, and slides with 1.5 of it.";

inline constexpr std::string_view hertz_set_up =
    "A punch with a face of 100 mm radius (E 20 GPa, ν 0.25, 20 × 10 mm, half of it meshed) let down without friction on a rigid flat to a "
    "half width of about 1 mm, 16 sides of triangles, within six periods; the answer is the mean over one more and compared at the load "
    "borne. Half width "
    "from "
    "the second moment of the pressure. The penalty is 10 E: a penalty of 1 E is a skin half an element thick, which widens the contact.";

inline constexpr std::string_view restitution_set_up =
    "Rigid triangles and blocks of 3 to 9 mm, moved by contact alone (E 30 GPa, penalty 1 E), meet at 1 to 10 m/s at random turns, offsets "
    "and spins: kinetic energy is what it was, to the time step's error. Elastic blocks of 12 mm in the solver, without friction or "
    "viscosity: with a contact slow against their waves they part as fast as they met; with the contact of 1 E the ledger closes and part "
    "of the energy rings in the blocks.";

}  // namespace fracfarm::verification
