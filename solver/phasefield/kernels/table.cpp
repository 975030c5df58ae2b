// The table of one instruction set's kernels.
#include "solver/phasefield/kernels.hpp"

namespace fracfarm::phasefield::FRACFARM_ISA {

void move(const View&, double dt);
void update_history(const View&);
void set_diagonal(const View&);
void extrapolate(const View&, const double* psi, double* previous, double* other);
double sweep(const View&, const double* psi, double* other, double omega);
EnergyDrop degrade(const View&, const double* psi);
StressSum internal_force(const View&);
double kinetic(const View&, double half_dt);
SurfaceSum surface(const View&, const double* psi);

#define FRACFARM_TEXT_OF(name) #name
#define FRACFARM_TEXT(name) FRACFARM_TEXT_OF(name)

extern const Kernels table;
const Kernels table{
    FRACFARM_TEXT(FRACFARM_ISA), move, update_history, set_diagonal, extrapolate, sweep, degrade, internal_force, kinetic, surface};

}  // namespace fracfarm::phasefield::FRACFARM_ISA
