// Central differences of rho u_tt = div sigma: displacements from velocities, velocities from forces.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_KERNELS {

void drift(const View& v, int j, Real dt) {
  const Index at = row_at(v, j);
  Real *ux = v.ux + at, *uz = v.uz + at;
  const Real *vx = v.vx + at, *vz = v.vz + at;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    ux[i] = ux[i] + dt * vx[i];
    uz[i] = uz[i] + dt * vz[i];
  }
  const Index last = v.columns - 1;
  for (Real* u : {ux, uz}) u[-1] = Real(2) * u[0] - u[1], u[last + 1] = Real(2) * u[last] - u[last - 1];
}

namespace {

// Any row.
INLINE void kick_row(const View& v, int j, Real dt, Sums& sums) {
  const Index at = row_at(v, j);
  const bool stores = v.keeps_forces || j == 0 || j == v.rows - 1;
  Real *fx = stores ? v.fx + at : scratch_row(v, first_free_row), *fz = stores ? v.fz + at : scratch_row(v, first_free_row + 1);
  if (is_elastic(v.law))
    elastic_forces(v, j, fx, fz, sums);
  else
    for (Index i = 0; i < v.padded; ++i) fx[i] = fz[i] = Real(0);
  for (Index i = 0; i < v.padded; i += width) {
    Wide x = load(fx + i), z = load(fz + i);
    add_half_edges(v, j, i, x, z);
    store(fx + i, x), store(fz + i, z);
  }
  for (int k = v.node_force_begin[j]; k < v.node_force_begin[j + 1]; ++k) {
    const NodeForce<Real>& force = v.node_forces[k];
    fx[force.column] += force.x, fz[force.column] += force.z;
  }
  if (!stores)
    for (const int i : {0, v.columns - 1}) v.fx[at + i] = fx[i], v.fz[at + i] = fz[i];
  Real *vx = v.vx + at, *vz = v.vz + at;
  const Real *mx = v.inverse_mass_x[j], *mz = v.inverse_mass_z[j];
  const Real* weight = v.column_weight;
  Partial energy;
  for (Index part = 0; part < lanes; part += width) {
    Wide sum{};
    for (Index i = part; i < v.padded; i += lanes) {
      const Wide before_x = load(vx + i), before_z = load(vz + i);
      const Wide x = before_x + dt * (load(fx + i) * load(mx + i)), z = before_z + dt * (load(fz + i) * load(mz + i));
      const Wide mean_x = before_x + x, mean_z = before_z + z;
      sum += load(weight + i) * (mean_x * mean_x + mean_z * mean_z);
      store(vx + i, x), store(vz + i, z);
    }
    store(energy.at + part, sum);
  }
  add(sums.kinetic, energy, 0.125 * double(v.node_rows[j].mass));
}

}  // namespace

void kick(const View& v, int first, int end, Real dt, Sums& sums) {
  const bool pulled = v.node_force_begin[first] < v.node_force_begin[end];
  if (v.node_rows[first].amid && is_elastic(v.law) && !pulled) return kick_strip(v, first, end, dt, sums);
  for (int j = first; j < end; ++j) kick_row(v, j, dt, sums);
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
