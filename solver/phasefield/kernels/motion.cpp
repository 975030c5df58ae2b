// Central differences and the internal force f = -B^T sigma of rho u_tt = div sigma; kinetic energy.
#include "solver/phasefield/kernels/rows.hpp"

namespace fracfarm::phasefield::FRACFARM_ISA {
namespace {

INLINE Stress degraded(double g, const Stress& s) { return {g * s.xx, g * s.zz, g * s.xz}; }

// What an element row gives to the force of its nodes.
struct ForceRows {
  double *sw_x, *se_x, *nw_x, *ne_x, *sw_z, *se_z, *nw_z, *ne_z;
};

INLINE void element_force(const ForceRows& f, Index i, const Stress& sw, const Stress& se, const Stress& nw, const Stress& ne, double per_x,
                          double per_z) {
  const double xx_south = per_x * (sw.xx + se.xx), xx_north = per_x * (nw.xx + ne.xx);
  const double zx_south = per_x * (sw.xz + se.xz), zx_north = per_x * (nw.xz + ne.xz);
  const double zz_west = per_z * (sw.zz + nw.zz), zz_east = per_z * (se.zz + ne.zz);
  const double xz_west = per_z * (sw.xz + nw.xz), xz_east = per_z * (se.xz + ne.xz);
  f.sw_x[i] = xx_south + xz_west;
  f.se_x[i] = xz_east - xx_south;
  f.nw_x[i] = xx_north - xz_west;
  f.ne_x[i] = -xx_north - xz_east;
  f.sw_z[i] = zx_south + zz_west;
  f.se_z[i] = zz_east - zx_south;
  f.nw_z[i] = zx_north - zz_west;
  f.ne_z[i] = -zx_north - zz_east;
}

INLINE void elastic_force_row(const View& v, int j, const ForceRows& f, const Stiffness& C) {
  const RowPair r = row_pair(v, j);
  const double *g0 = v.g + Index(j) * v.stride, *g1 = g0 + v.stride;
  const double per_x = v.corner_area / v.hx, per_z = v.corner_area / v.hz;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    element_force(f, i, degraded(g0[i], law::stress(C, e.sw)), degraded(g0[i + 1], law::stress(C, e.se)),
                  degraded(g1[i], law::stress(C, e.nw)), degraded(g1[i + 1], law::stress(C, e.ne)), per_x, per_z);
  }
}

INLINE Stress secant_stress(const law::Secant<double>& secant, double s, const Strain& e) {
  return law::stress(law::reduced_stiffness(secant, s), e);
}

INLINE void secant_force_row(const View& v, int j, const ForceRows& f, const law::Secant<double>& secant) {
  const RowPair r = row_pair(v, j);
  const Index at = Index(j) * v.stride;
  const double *S0 = v.reduction[0] + at, *S1 = v.reduction[1] + at, *S2 = v.reduction[2] + at, *S3 = v.reduction[3] + at;
  const double *g0 = v.g + at, *g1 = g0 + v.stride;
  const double per_x = v.corner_area / v.hx, per_z = v.corner_area / v.hz;
#pragma omp simd
  for (Index i = 0; i < v.padded; ++i) {
    const Corners e = corner_strains(r, i);
    element_force(f, i, degraded(g0[i], secant_stress(secant, S0[i], e.sw)), degraded(g0[i + 1], secant_stress(secant, S1[i], e.se)),
                  degraded(g1[i], secant_stress(secant, S2[i], e.nw)), degraded(g1[i + 1], secant_stress(secant, S3[i], e.ne)), per_x,
                  per_z);
  }
}

// The law is chosen once for a row.
INLINE void force_row(const View& v, int j, const ForceRows& f) {
  const ElementRow& row = v.element_rows[j];
  if (v.row_yields[j])
    secant_force_row(v, j, f, row.secant);
  else
    elastic_force_row(v, j, f, row.stiffness);
}

}  // namespace

void move(const View& v, double dt) {
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
    double *ux = v.ux + at, *uz = v.uz + at, *vx = v.vx + at, *vz = v.vz + at;
    const double *fx = v.fx + at, *fz = v.fz + at, *mx = v.inverse_mass_x + at, *mz = v.inverse_mass_z + at;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      vx[i] = vx[i] + dt * (fx[i] * mx[i]);
      ux[i] = ux[i] + dt * vx[i];
      vz[i] = vz[i] + dt * (fz[i] * mz[i]);
      uz[i] = uz[i] + dt * vz[i];
    }
  }
}

StressSum internal_force(const View& v) {
  StressSum sum{0.0, 0.0};
  const ForceRows f{scratch_row(v, 0), scratch_row(v, 1), scratch_row(v, 2), scratch_row(v, 3),
                    scratch_row(v, 4), scratch_row(v, 5), scratch_row(v, 6), scratch_row(v, 7)};
  double *xx = scratch_row(v, 8), *zz = scratch_row(v, 9);
  for (Index i = 0; i < v.padded; ++i) v.fx[i] = v.fz[i] = 0.0;
  for (int j = 0; j + 1 < v.rows; ++j) {
    force_row(v, j, f);
    for (double* row : {f.sw_x, f.se_x, f.nw_x, f.ne_x, f.sw_z, f.se_z, f.nw_z, f.ne_z}) clear_pad(v, row);
    double *fx0 = v.fx + Index(j) * v.stride, *fz0 = v.fz + Index(j) * v.stride, *fx1 = fx0 + v.stride, *fz1 = fz0 + v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      fx0[i] = fx0[i] + (f.sw_x[i] + f.se_x[i - 1]);
      fz0[i] = fz0[i] + (f.sw_z[i] + f.se_z[i - 1]);
      fx1[i] = f.nw_x[i] + f.ne_x[i - 1];
      fz1[i] = f.nw_z[i] + f.ne_z[i - 1];
      xx[i] = f.sw_x[i] + f.nw_x[i];  // the shears cancel: hx times this is the integral of sigma_xx over the element
      zz[i] = f.sw_z[i] + f.se_z[i];
    }
    sum.xx += v.hx * ordered_sum(xx, v.padded);
    sum.zz += v.hz * ordered_sum(zz, v.padded);
  }
  return sum;
}

double kinetic(const View& v, double half_dt) {
  double* energy = scratch_row(v, 0);
  double sum = 0.0;
  for (int j = 0; j < v.rows; ++j) {
    const Index at = Index(j) * v.stride;
#pragma omp simd
    for (Index i = 0; i < v.padded; ++i) {
      const double x = v.vx[at + i] + half_dt * (v.fx[at + i] * v.inverse_mass_x[at + i]);
      const double z = v.vz[at + i] + half_dt * (v.fz[at + i] * v.inverse_mass_z[at + i]);
      energy[i] = 0.5 * v.mass[at + i] * (x * x + z * z);
    }
    sum += ordered_sum(energy, v.padded);
  }
  return sum;
}

}  // namespace fracfarm::phasefield::FRACFARM_ISA
