// The benchmark rows that run the dataset's own samples, and how they are set up.
#pragma once

#include <string_view>

#include "tests/verification/cases.hpp"

namespace fracfarm::verification {

std::vector<Row> mesh_size(Desk&);      // FD-13
std::vector<Row> paper_loading(Desk&);  // FD-14
std::vector<Row> slivers(Desk&);        // FD-15

inline constexpr std::string_view mesh_size_set_up =
    "Sample 1 of shale (250 mm square, random orthogonal cracks, plates pulled at 1 m/s behind a ramp of 0.1 ms), fast tier, elements of "
    "6, 3 "
    "and 1.5 mm, to 1.8 times the stress drop. What the body as a whole answers must keep; where each crack runs need not, and is "
    "reported. "
    "Several meshes and patterns of each size are in ACCURACY.md.";

inline constexpr std::string_view paper_loading_set_up =
    "Sample 1 of shale, tungsten and pbx5 and sample 7 of pbx, whose ledger closes worst of twelve, between plates in the reference tier "
    "(p = 100 E/h, double), to 1.8 times the stress drop: kinetic, elastic, plastic, fracture, viscous, contact and friction energies "
    "against the plates' work at every row of the series. The five-step pick on 200 piecewise straight signals, each with its answer "
    "written into it.";

inline constexpr std::string_view slivers_set_up =
    "Tiny elements injected three ways. 400 pairs of cracks on a 60 mm plate that miss each other by 3 nm to 3 mm, for the mesher to "
    "repair or "
    "refuse; users' mesh files with one element below the gate's height; and a mesh that goes round the gate, vibrating freely from a "
    "strain "
    "of 1e-6: with a sound mesh's step its energy must be seen to grow, with its own step it must not.";

}  // namespace fracfarm::verification
