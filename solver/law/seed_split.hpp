// The seed's positive energy: normal strains clipped at zero, shear not (seed paper, eqs 5-7). Not invariant under rotation; labelled so.
#pragma once

#include "solver/law/elastic.hpp"

namespace fracfarm::law {

// Phi+ = 1/2 [C11 <e_xx>^2 + 2 C13 <e_xx><e_zz> + C33 <e_zz>^2 + C55 gamma^2], J/m^3.
FRACFARM_POINTWISE double positive_energy(const Stiffness& C, const Strain& e) {
  return strain_energy(C, {e.xx > 0.0 ? e.xx : 0.0, e.zz > 0.0 ? e.zz : 0.0, e.xz});
}

}  // namespace fracfarm::law
