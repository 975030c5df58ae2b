// The table of one instruction set's kernels for one number type.
#include "solver/fdem/kernels.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {

using Real = FRACFARM_REAL;

AdvanceSums advance(const View<Real>&, Blocks, Real dt);
TriangleSums measure(const View<Real>&, Blocks, Real dt);
void join(const View<Real>&, Blocks);
double follow(const View<Real>&, Blocks);

#define FRACFARM_TEXT_OF(name) #name
#define FRACFARM_TEXT(name) FRACFARM_TEXT_OF(name)

extern const Kernels<Real> table;
const Kernels<Real> table{FRACFARM_TEXT(FRACFARM_ISA), advance, measure, join, follow};

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
