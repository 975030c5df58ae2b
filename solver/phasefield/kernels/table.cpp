// The table of one instruction set's kernels for one number type.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {

void drift(const View&, int j, Real dt);
double history(const View&, int j);
bool damages(const View&, int j, Real bound);
void guess(const View&, int j, const Real* psi, Real* previous);
double sweep(const View&, int j, const Real* psi, Real* next, Real omega, bool last);
double settle(const View&, int j, Real* psi);
RowSums force(const View&, int j, const Real* psi, const Real* before);
double kick(const View&, int j, Real dt);
void forget(const View&, int j);
SurfaceSum surface(const View&, int j, const Real* psi);

#define FRACFARM_TEXT_OF(name) #name
#define FRACFARM_TEXT(name) FRACFARM_TEXT_OF(name)

extern const Kernels<Real> table;
const Kernels<Real> table{FRACFARM_TEXT(FRACFARM_ISA), drift, history, damages, guess, sweep, settle, force, kick, forget, surface};

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
