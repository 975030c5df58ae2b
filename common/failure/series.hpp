// Named columns of equal length: one row every few steps of a run. Shared by the solver (writes), the failure criteria and the record.
#pragma once

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
    {"mean_stress", "Pa", true, "mean vertical stress of the sample, degraded, area-weighted: what stress_drop looks at"},
    {"mean_stress_xx", "Pa", false, "mean horizontal stress of the sample"},
    {"total_stress", "Pa", false, "what the five-step pick looks at; mean_stress where it is absent"},
    {"stress_left", "Pa", false, "mean normal stress on the side"},
    {"stress_right", "Pa", false, "mean normal stress on the side"},
    {"stress_bottom", "Pa", false, "mean normal stress on the side"},
    {"stress_top", "Pa", false, "mean normal stress on the side"},
    {"kinetic_energy", "J/m", true, "kinetic energy"},
    {"elastic_energy", "J/m", true, "stored elastic energy, degraded"},
    {"released_energy", "J/m", false, "elastic energy given up to damage; the crack's share of the ledger in the phase field"},
    {"plastic_energy", "J/m", false, "plastic work"},
    {"fracture_energy", "J/m", false, "crack surface energy"},
    {"viscous_energy", "J/m", false, "dissipated by viscosity"},
    {"contact_energy", "J/m", false, "stored in contacts"},
    {"friction_energy", "J/m", false, "dissipated by friction"},
    {"external_work", "J/m", true, "work of the loads since the start"},
    {"energy_residual", "J/m", true, "external work less what became of it"},
    {"crack_length", "m", false, "crack surface over Gc, or length of broken edges"},
    {"dt", "s", false, "time step"},
    {"solver_iterations", "1", false, "sweeps or iterations since the row before"},
    {"max_velocity", "m/s", false, "largest nodal speed"},
}};

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
