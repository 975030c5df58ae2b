// A small record that satisfies every rule: a crack that grows along one row of nodes until it is through, with a ledger that closes.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/base/build_info.hpp"
#include "common/record/record.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm::sample {

struct Size {
  int cells_x = 15;
  int cells_z = 11;
  int frames = 9;
  int rows = 60;  // of the series
};

inline Scene scene_of_size(const Size& size) {
  const std::string text =
      R"({"schema": "fracfarm.scene/1", "method": "phase_field", "material": "pbx", "domain": {"width": 0.25, "height": 0.2},
    "cracks": [[0.02, 0.1, 0.06, 0.1], [0.2, 0.05, 0.2, 0.08]],
    "loads": {"top": {"normal_velocity": 1.0}, "bottom": {"normal_velocity": 1.0}, "left": "free", "right": "free"},
    "time": {"frame_interval": 5e-6, "horizon": 1e-3}, "phase_field": {"cells": [)" +
      std::to_string(size.cells_x) + "," + std::to_string(size.cells_z) + "]}}";
  return parse_scene(text).value();
}

inline void fill_fields(PhaseFieldFrames& f, const Size& size, const Scene& scene) {
  const int columns = size.cells_x + 1, rows = size.cells_z + 1, middle = rows / 2;
  for (int i = 0; i < columns; ++i) f.x.push_back(scene.width * i / size.cells_x);
  for (int k = 0; k < rows; ++k) f.z.push_back(scene.height * k / size.cells_z);
  const auto field = [&](double tip) {  // psi = 1 up to `tip` along the middle row, falling off away from it
    std::vector<float> psi;
    for (int k = 0; k < rows; ++k)
      for (int i = 0; i < columns; ++i) psi.push_back(static_cast<float>(std::exp(-0.9 * std::hypot(std::max(0.0, i - tip), k - middle))));
    return psi;
  };
  for (int t = 0; t < size.frames; ++t) {
    f.time.push_back(5e-6 * t);
    f.psi.push_back(field(2.0 + (columns - 3.0) * t / (size.frames - 1)));
  }
  f.psi_initial = f.psi.front();
  f.psi_failure = f.psi.back();
  for (float psi : f.psi_initial) f.mask_initial.push_back(psi == 1.0f);
}

// Stress rises and collapses by two thirds of the rows; external work is what the energies hold.
inline Series series_of_size(const Size& size) {
  Series series;
  for (const ColumnRow& row : series_table)
    if (row.required || row.name == "released_energy" || row.name == "stress_xx")
      series.columns.push_back({std::string(row.name), std::string(row.unit), {}});
  for (int i = 0; i < size.rows; ++i) {
    const double t = 40e-6 * i / (size.rows - 1), s = static_cast<double>(i) / size.rows;
    const double stress = 7e6 * (s < 0.6 ? s / 0.6 : std::max(0.0, 1.0 - (s - 0.6) / 0.1)), kinetic = 3.0 * s, elastic = stress * 1e-5,
                 released = 20.0 * s * s;
    for (Column& column : series.columns) {
      double value = 0.0;
      if (column.name == "step_time") value = t;
      if (column.name == "stress_zz" || column.name == "total_stress") value = stress;
      if (column.name == "kinetic_energy") value = kinetic;
      if (column.name == "elastic_energy") value = elastic;
      if (column.name == "released_energy") value = released;
      if (column.name == "energy_residual") value = 1e-3 * s;
      if (column.name == "external_work") value = kinetic + elastic + released - 1e-3 * s;
      column.values.push_back(value);
    }
  }
  return series;
}

inline Record record(const Size& size = {}) {
  const Scene scene = scene_of_size(size);
  Record r;
  r.canonical_scene = canonical_text(scene);
  r.provenance = {
      {"build_id", build_info().build_id}, {"compiler", build_info().compiler}, {"flags", build_info().flags}, {"attempt", "1"}};
  r.key = job_key(r.canonical_scene, r.provenance["build_id"]);
  r.method = name_of(scene.method);
  r.material = material_name(scene);
  r.boundary_condition = "scene";
  r.cracks = scene.cracks;
  fill_fields(r.phase_field, size, scene);
  r.series = series_of_size(size);
  const auto times = r.series["step_time"], stress = r.series["stress_zz"];
  r.failure_times = {{"through_crack", r.phase_field.time.back()},
                     {"stress_drop", stress_drop(times, stress)},
                     {"five_step", five_step(times, r.series["total_stress"], r.series["kinetic_energy"])}};
  r.judgement = judge(r.method, r.failure_times, "horizon");
  r.peak_stress = *std::max_element(stress.begin(), stress.end());
  const auto residual = r.series["energy_residual"], work = r.series["external_work"];
  r.energy_residual = *std::max_element(residual.begin(), residual.end()) / *std::max_element(work.begin(), work.end());
  return r;
}

}  // namespace fracfarm::sample
