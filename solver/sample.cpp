#include "solver/sample.hpp"

#include <cassert>
#include <string>

#include "common/scene/scene.hpp"

namespace fracfarm {
namespace {

template <Side side>
double reaction(const SampleRow& s) {
  return s.reaction[static_cast<std::size_t>(side)];
}

// total_stress, which the five-step pick reads, is the trace of the mean stress: it falls for cracks of any direction.
constexpr std::array<SeriesColumn, 18> table{{
    {"step_time", [](const SampleRow& s) { return s.step_time; }},
    {"stress_zz", [](const SampleRow& s) { return s.stress_zz; }},
    {"stress_xx", [](const SampleRow& s) { return s.stress_xx; }},
    {"total_stress", [](const SampleRow& s) { return s.stress_xx + s.stress_zz; }},
    {"reaction_left", reaction<Side::left>},
    {"reaction_right", reaction<Side::right>},
    {"reaction_bottom", reaction<Side::bottom>},
    {"reaction_top", reaction<Side::top>},
    {"kinetic_energy", [](const SampleRow& s) { return s.kinetic_energy; }},
    {"elastic_energy", [](const SampleRow& s) { return s.elastic_energy; }},
    {"released_energy", [](const SampleRow& s) { return s.released_energy; }},
    {"plastic_energy", [](const SampleRow& s) { return s.plastic_energy; }},
    {"surface_energy", [](const SampleRow& s) { return s.surface_energy; }},
    {"external_work", [](const SampleRow& s) { return s.external_work; }},
    {"energy_residual", [](const SampleRow& s) { return s.energy_residual; }},
    {"crack_length", [](const SampleRow& s) { return s.crack_length; }},
    {"dt", [](const SampleRow& s) { return s.dt; }},
    {"solver_iterations", [](const SampleRow& s) { return static_cast<double>(s.solver_iterations); }},
}};

std::string unit_of(std::string_view name) {
  for (const ColumnRow& row : series_table)
    if (row.name == name) return std::string(row.unit);
  assert(false && "a column that the series table does not know");
  return {};
}

}  // namespace

double energy_residual(const SampleRow& now, double initial_energy) {
  return now.kinetic_energy + now.elastic_energy + now.released_energy + now.plastic_energy + now.fracture_energy + now.viscous_energy +
         now.contact_energy + now.friction_energy - initial_energy - now.external_work;
}

std::span<const SeriesColumn> series_columns() { return table; }

Series empty_series() {
  Series series;
  for (const SeriesColumn& column : table) series.columns.push_back({std::string(column.name), unit_of(column.name), {}});
  return series;
}

void append(Series& series, const SampleRow& sample) {
  for (std::size_t c = 0; c < table.size(); ++c) series.columns[c].values.push_back(table[c].of(sample));
}

}  // namespace fracfarm
