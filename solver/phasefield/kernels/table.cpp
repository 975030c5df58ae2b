// The table of one instruction set's kernels for one number type.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {

void drift(const View&, int j, Real dt);
double history(const View&, int j);
void equation(const View&, int j);
bool damages(const View&, int j, Real bound);
void guess(const View&, int j, const Real* psi, Real* previous);
double sweep(const View&, int j, const Real* psi, Real* next, Real omega, bool last);
double settle(const View&, int j, Real* psi);
void rest(const View&, int j, const Real* psi, Real* previous, Real* other);
double elastic_energy(const View&, int j);
void degrade(const View&, int begin, int end, const Real* psi, const Real* before, Sums&);
void force(const View&, int begin, int end, Sums&);
void kick(const View&, int first, int end, Real dt, Sums&);
void surface(const View&, int begin, int end, const Real* psi, SurfaceParts&);
bool differs(const Real* psi, Real limit, const unsigned char* marks, int count);

#define FRACFARM_TEXT_OF(name) #name
#define FRACFARM_TEXT(name) FRACFARM_TEXT_OF(name)

extern const Kernels<Real> table;
const Kernels<Real> table{FRACFARM_TEXT(FRACFARM_ISA),
                          drift,
                          history,
                          equation,
                          damages,
                          guess,
                          sweep,
                          settle,
                          rest,
                          elastic_energy,
                          degrade,
                          force,
                          kick,
                          surface,
                          differs};

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
