// The benchmark rows of FDEM, beside those of the phase field in the same table; and how they are set up, for the page VERIFICATION.md.
#pragma once

#include "tests/verification/cases.hpp"

namespace fracfarm::verification {

std::vector<Row> one_joint(Desk&);          // FD-1
std::vector<Row> objectivity(Desk&);        // FD-2
std::vector<Row> joint_chain(Desk&);        // FD-3
std::vector<Row> step_limit(Desk&);         // FD-4
std::vector<Row> spall(Desk&);              // FD-5
std::vector<Row> double_cantilever(Desk&);  // FD-6
std::vector<Row> end_notched(Desk&);        // FD-7
std::vector<Row> brazilian_disc(Desk&);     // FD-11
std::vector<Row> centre_crack(Desk&);       // FD-12

}  // namespace fracfarm::verification
