// What leaves a simulation at one instant, and the table of the series' columns. Energies and work are per metre of thickness.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "common/failure/series.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm {

struct SampleRow {
  double step_time = 0.0;            // s
  double stress_xx = 0.0;            // Pa, degraded, mean over the area
  double stress_zz = 0.0;            // Pa
  std::array<double, 4> reaction{};  // Pa, by Side: outward force on the side's held nodes over the side's length
  double kinetic_energy = 0.0;       // J/m
  double elastic_energy = 0.0;       // J/m, stored and degraded; the potential of the secant law where that yields
  double released_energy = 0.0;      // J/m, drop of the stored energy by degradation at fixed strain, since t = 0
  double plastic_energy = 0.0;       // J/m, degraded plastic work since t = 0
  double fracture_energy = 0.0;      // J/m, work of the joints that is gone (FDEM)
  double viscous_energy = 0.0;       // J/m, dissipated by viscosity
  double contact_energy = 0.0;       // J/m, stored in contacts
  double friction_energy = 0.0;      // J/m, dissipated by friction
  double surface_energy = 0.0;       // J/m, AT2 functional less its value at t = 0
  double external_work = 0.0;        // J/m
  double energy_residual = 0.0;      // J/m, see energy_residual() below
  double crack_length = 0.0;         // m, twice the gradient part of the AT2 functional over G_c
  double dt = 0.0;                   // s
  long long solver_iterations = 0;   // sweeps of the psi equation since t = 0; the series holds their growth from row to row
};

// The ledger: kinetic + elastic + released + plastic + fracture + viscous + contact + friction - what was there at t = 0 - external work,
// which is 0 for an exact scheme. J/m.
double energy_residual(const SampleRow& now, double initial_energy);

struct SeriesColumn {
  std::string_view name;  // of common/failure's series_table, which gives the unit
  unsigned kinds;         // of simulations that have it: grids, meshes
  double (*of)(const SampleRow&);
};

Series empty_series(Method method);
void append(Series& series, const SampleRow& sample);

}  // namespace fracfarm
