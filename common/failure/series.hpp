// Named columns of equal length: one row every few steps of a run. Shared by the solver (writes), the failure criteria and the record.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm {

// Columns that the failure criteria, the validator and the pictures look for; a series may have more.
struct ColumnRow {
  std::string_view name;
  std::string_view unit;  // energies per metre of thickness
  bool required;
  std::string_view meaning;
};

inline constexpr std::array<ColumnRow, 22> series_table{{
    {"step_time", "s", true, "simulated time of the row"},
    {"stress_xx", "Pa", false, "mean horizontal stress of the sample, degraded, area-weighted"},
    {"stress_zz", "Pa", true, "mean vertical stress of the sample, degraded, area-weighted: what the stress drop looks at"},
    {"total_stress", "Pa", true, "sum of the mean normal stresses: what the five-step pick looks at"},
    {"reaction_left", "Pa", false, "outward force on the side over its length"},
    {"reaction_right", "Pa", false, "outward force on the side over its length"},
    {"reaction_bottom", "Pa", false, "outward force on the side over its length"},
    {"reaction_top", "Pa", false, "outward force on the side over its length"},
    {"kinetic_energy", "J/m", true, "kinetic energy"},
    {"elastic_energy", "J/m", true, "stored elastic energy, degraded"},
    {"released_energy", "J/m", false, "elastic energy given up to damage"},
    {"plastic_energy", "J/m", false, "plastic work"},
    {"fracture_energy", "J/m", false, "work of the joints"},
    {"viscous_energy", "J/m", false, "dissipated by viscosity"},
    {"contact_energy", "J/m", false, "stored in contacts"},
    {"friction_energy", "J/m", false, "dissipated by friction"},
    {"surface_energy", "J/m", false, "crack surface energy of the phase field; not in the ledger, released energy is"},
    {"external_work", "J/m", true, "work of the loads since the start"},
    {"energy_residual", "J/m", true, "what the energies hold more than the external work brought"},
    {"crack_length", "m", false, "length of the cracks"},
    {"dt", "s", false, "time step"},
    {"solver_iterations", "1", false, "sweeps or iterations of the damage equation"},
}};

// The energy ledger may miss by this share of the largest energy that was ever in it: the time loop ends a run that misses by more, and the
// validator refuses its record. Runs that are well have 0.0001 to 0.001.
inline constexpr double energy_residual_limit = 0.02;

// After a velocity step the ledger's kinetic energy, taken at whole steps, counts modes of the grid's own frequency too high: by 7 %/n of
// the energy after n steps in each of the dataset's materials. A row of the first steps counts by this share, so that no run is too short
// to be judged.
inline double ledger_weight(double steps) {
  const double settled = std::min(1.0, steps / 8.0);
  return settled * settled;
}

struct Column {
  std::string name;
  std::string unit;
  std::vector<double> values;
};

struct Series {
  std::vector<Column> columns;  // the first is step_time (s)

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  const Column* find(std::string_view name) const {
    for (const Column& column : columns)
      if (column.name == name) return &column;
    return nullptr;
  }
  std::span<const double> operator[](std::string_view name) const {
    const Column* column = find(name);
    assert(column && "no such column");
    return column->values;
  }
};

}  // namespace fracfarm
