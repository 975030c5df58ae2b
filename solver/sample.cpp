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

constexpr unsigned grid = 1, mesh = 2, both = grid | mesh;

// total_stress, which the five-step pick reads, is the trace of the mean stress: it falls for cracks of any direction.
constexpr std::array<SeriesColumn, 22> table{{
    {"step_time", both, [](const SampleRow& s) { return s.step_time; }},
    {"stress_zz", both, [](const SampleRow& s) { return s.stress_zz; }},
    {"stress_xx", both, [](const SampleRow& s) { return s.stress_xx; }},
    {"total_stress", both, [](const SampleRow& s) { return s.stress_xx + s.stress_zz; }},
    {"reaction_left", both, reaction<Side::left>},
    {"reaction_right", both, reaction<Side::right>},
    {"reaction_bottom", both, reaction<Side::bottom>},
    {"reaction_top", both, reaction<Side::top>},
    {"kinetic_energy", both, [](const SampleRow& s) { return s.kinetic_energy; }},
    {"elastic_energy", both, [](const SampleRow& s) { return s.elastic_energy; }},
    {"released_energy", grid, [](const SampleRow& s) { return s.released_energy; }},
    {"plastic_energy", both, [](const SampleRow& s) { return s.plastic_energy; }},
    {"fracture_energy", mesh, [](const SampleRow& s) { return s.fracture_energy; }},
    {"viscous_energy", mesh, [](const SampleRow& s) { return s.viscous_energy; }},
    {"contact_energy", mesh, [](const SampleRow& s) { return s.contact_energy; }},
    {"friction_energy", mesh, [](const SampleRow& s) { return s.friction_energy; }},
    {"surface_energy", grid, [](const SampleRow& s) { return s.surface_energy; }},
    {"external_work", both, [](const SampleRow& s) { return s.external_work; }},
    {"energy_residual", both, [](const SampleRow& s) { return s.energy_residual; }},
    {"crack_length", both, [](const SampleRow& s) { return s.crack_length; }},
    {"dt", both, [](const SampleRow& s) { return s.dt; }},
    {"solver_iterations", grid, [](const SampleRow& s) { return static_cast<double>(s.solver_iterations); }},
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

Series empty_series(Method method) {
  Series series;
  for (const SeriesColumn& column : table)
    if (column.kinds & (method == Method::fdem ? mesh : grid))
      series.columns.push_back({std::string(column.name), unit_of(column.name), {}});
  return series;
}

// The series has its columns in the table's order.
void append(Series& series, const SampleRow& sample) {
  auto column = series.columns.begin();
  for (const SeriesColumn& known : table)
    if (column != series.columns.end() && column->name == known.name) (column++)->values.push_back(known.of(sample));
}

}  // namespace fracfarm
