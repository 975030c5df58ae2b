// Families whose benchmarks follow from tables of the solver, so that they are registered when the program starts.
#pragma once

namespace fracfarm::benchmarks {

void register_kernels();     // each kernel of the row table, for every path and number type that runs here
void register_steps();       // whole steps of a run stopped in the middle, with the share of each stage
void register_fdem_steps();  // the same of FDEM, before and after joints break

}  // namespace fracfarm::benchmarks
