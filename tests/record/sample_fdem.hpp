// A small FDEM record that satisfies every rule: a crack that runs along a row of edges from one initial crack to the next and on to both
// sides, with a ledger that closes and a series on which drop10 and the five-step pick both exist.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "common/base/build_info.hpp"
#include "common/record/record.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm::sample {

struct FdemSize {
  int cells_x = 20;  // each two triangles; the scene's cracks lie on the lines between the cells of 10 x 8 and their multiples
  int cells_z = 16;
  int frames = 9;
  int rows = 120;  // of the series
};

inline constexpr double fdem_end = 3e-4;  // s, of the run

inline Scene fdem_scene(const FdemSize& size) {
  const std::string text =
      R"({"schema": "fracfarm.scene/1", "method": "fdem", "material": "shale", "domain": {"width": 0.25, "height": 0.2},
    "cracks": [[0.05, 0.1, 0.1, 0.1], [0.2, 0.05, 0.2, 0.15]],
    "loads": {"top": {"normal_velocity": 1.0, "tangential": "fixed", "ramp": 1e-4}, "bottom": {"normal_velocity": 1.0, "tangential": "fixed", "ramp": 1e-4},
              "left": "free", "right": "free"},
    "time": {"frame_interval": 1e-5, "horizon": 1e-3}, "fdem": {"element_size": )" +
      std::to_string(0.25 / size.cells_x) + "}}";
  return parse_scene(text).value();
}

// Squares cut in two, the cut turning from square to square; nodes inside are moved at random, but none of the lines with cracks.
inline TriangleMesh fdem_mesh(const FdemSize& size, const Scene& scene) {
  TriangleMesh mesh;
  const double dx = scene.width / size.cells_x, dz = scene.height / size.cells_z;
  std::uint64_t state = 1;
  const auto moved = [&] {
    return 0.2 * (static_cast<double>((state = state * 6364136223846793005u + 1442695040888963407u) >> 40) / (1 << 24) - 0.5);
  };
  for (int k = 0; k <= size.cells_z; ++k)
    for (int i = 0; i <= size.cells_x; ++i) {
      const bool held = i == 0 || k == 0 || i == size.cells_x || k == size.cells_z || 2 * k == size.cells_z || 5 * i == 4 * size.cells_x;
      mesh.nodes.push_back({dx * (i + (held ? 0.0 : moved())), dz * (k + (held ? 0.0 : moved()))});
    }
  const auto node = [&](int i, int k) { return k * (size.cells_x + 1) + i; };
  for (int k = 0; k < size.cells_z; ++k)
    for (int i = 0; i < size.cells_x; ++i) {
      const int a = node(i, k), b = node(i + 1, k), c = node(i + 1, k + 1), d = node(i, k + 1);
      const auto two = (i + k) % 2 ? std::array<std::array<int, 3>, 2>{{{a, b, c}, {a, c, d}}}
                                   : std::array<std::array<int, 3>, 2>{{{a, b, d}, {b, c, d}}};
      mesh.triangles.insert(mesh.triangles.end(), two.begin(), two.end());
    }
  std::map<std::array<int, 2>, int> left;  // triangle at the left of a way
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (std::size_t s = 0; s < 3; ++s)
      left[{mesh.triangles[static_cast<std::size_t>(t)][s], mesh.triangles[static_cast<std::size_t>(t)][(s + 1) % 3]}] = t;
  for (const auto& [way, triangle] : left) {
    const auto right = left.find({way[1], way[0]});
    if (right == left.end() || way[0] > way[1]) continue;
    mesh.edge_nodes.push_back(way);
    mesh.edge_triangles.push_back({triangle, right->second});
  }
  return mesh;
}

struct Edge {
  double x, z;      // m, middle
  bool horizontal;  // along the row of the crack
};

inline Edge edge_at(const TriangleMesh& mesh, std::size_t e) {
  const auto &a = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[e][0])],
             &b = mesh.nodes[static_cast<std::size_t>(mesh.edge_nodes[e][1])];
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), a[1] == b[1]};
}

inline bool is_crack(const Edge& edge, const std::array<double, 2>& a, const std::array<double, 2>& b, const Scene& scene) {
  return std::any_of(scene.cracks.begin(), scene.cracks.end(), [&](const Segment& s) {
    const double tolerance = 1e-9;
    const bool along = s.z0 == s.z1 ? std::abs(a[1] - s.z0) < tolerance && std::abs(b[1] - s.z0) < tolerance
                                    : std::abs(a[0] - s.x0) < tolerance && std::abs(b[0] - s.x0) < tolerance;
    return along && edge.x > s.x0 - tolerance && edge.x < s.x1 + tolerance && edge.z > s.z0 - tolerance && edge.z < s.z1 + tolerance;
  });
}

// When the joints of the middle row break: from the first crack outward.
inline double arrival(double x, const Scene& scene) { return 1e-4 + 6e-5 * std::abs(x - 0.075) / scene.width; }

inline std::vector<float> damage_at(const FdemFrames& f, double time) {
  std::vector<float> damage;
  for (std::size_t e = 0; e < f.mesh.edge_nodes.size(); ++e) {
    const Edge edge = edge_at(f.mesh, e);
    const double away = std::abs(edge.z - 0.1), grown = std::clamp((time - 5e-5) / 2e-4, 0.0, 1.0);
    double value = 0.9 * grown * std::exp(-away / 0.01) - 0.05;  // around the crack joints soften and do not break
    if (f.break_time[e] <= time)
      value = 1.0;
    else if (!std::isnan(f.break_time[e]))
      value = std::max(value, std::min(0.99, 1.0 - (f.break_time[e] - time) / 3e-5));
    damage.push_back(f.mesh.edge_kind[e] == EdgeKind::crack ? 2.0f : static_cast<float>(std::max(0.0, value)));
  }
  return damage;
}

inline void fill_frames(FdemFrames& f, const FdemSize& size, const Scene& scene) {
  f.mesh = fdem_mesh(size, scene);
  for (std::size_t e = 0; e < f.mesh.edge_nodes.size(); ++e) {
    const Edge edge = edge_at(f.mesh, e);
    const auto end = [&](std::size_t k) { return f.mesh.nodes[static_cast<std::size_t>(f.mesh.edge_nodes[e][k])]; };
    const bool crack = is_crack(edge, end(0), end(1), scene), breaks = !crack && edge.horizontal && std::abs(edge.z - 0.1) < 1e-9;
    f.mesh.edge_kind.push_back(crack ? EdgeKind::crack : EdgeKind::joint);
    f.break_time.push_back(breaks ? arrival(edge.x, scene) : std::numeric_limits<double>::quiet_NaN());
    f.break_mode.push_back(breaks ? static_cast<unsigned char>(1 + e % 3) : 0);
  }
  for (int t = 0; t < size.frames; ++t) {
    f.time.push_back(fdem_end * t / (size.frames - 1));
    f.damage.push_back(damage_at(f, f.time.back()));
  }
  f.damage_initial = f.damage.front();
}

// Loss of the stress at 40 % of the rows, after it kinetic energy and stress ring down; external work is what the energies hold.
inline Series fdem_series(const FdemSize& size) {
  Series series;
  for (const ColumnRow& row : series_table) {
    const bool left_out = row.name == "released_energy" || row.name == "surface_energy" || row.name == "solver_iterations" ||
                          row.name.starts_with("reaction");
    if (!left_out) series.columns.push_back({std::string(row.name), std::string(row.unit), {}});
  }
  for (int i = 0; i < size.rows; ++i) {
    const double s = (i + 1.0) / size.rows, after = (s - 0.4) / 0.6;
    std::map<std::string, double> row{{"step_time", fdem_end * s}, {"dt", 8e-8}};
    const double stress = after < 0.0 ? 6e6 * s / 0.4 : 6e6 * std::cos(14.0 * after) * std::exp(-4.0 * after);
    row["stress_zz"] = stress, row["total_stress"] = 1.2 * stress, row["stress_xx"] = 0.2 * stress;
    row["kinetic_energy"] = 20.0 * s + (after < 0.0 ? 0.0 : 80.0 * std::exp(-std::pow((after - 0.1) / 0.07, 2)));
    row["elastic_energy"] = 1e-12 * stress * stress;
    row["plastic_energy"] = 0.0, row["fracture_energy"] = after < 0.0 ? 0.0 : 5.0 * (1.0 - std::exp(-6.0 * after));
    row["viscous_energy"] = 3.0 * s, row["contact_energy"] = after < 0.0 ? 0.0 : 0.1 * after, row["friction_energy"] = 0.2 * s * s;
    row["crack_length"] = after < 0.0 ? 0.0 : 0.15;
    row["energy_residual"] = 1e-2 * s;
    for (const char* held : {"kinetic_energy", "elastic_energy", "fracture_energy", "viscous_energy", "contact_energy", "friction_energy"})
      row["external_work"] += row[held];
    row["external_work"] -= row["energy_residual"];
    for (Column& column : series.columns) column.values.push_back(row.at(column.name));
  }
  return series;
}

// What follows from series and frames.
inline void judge_fdem(Record& r) {
  const auto time = r.series["step_time"], stress = r.series["stress_zz"];
  r.failure_times = {
      {"drop10", of_broken_body(stress_drop(time, stress), r.fdem.break_time)},
      {"five_step", of_broken_body(five_step(time, r.series["total_stress"], r.series["kinetic_energy"]), r.fdem.break_time)}};
  r.judgement = judge(r.method, r.failure_times, "horizon");
  r.fdem.damage_failure = damage_at(r.fdem, r.judgement.time_to_failure.value_or(fdem_end));
  r.peak_stress = *std::max_element(stress.begin(), stress.end());
  const auto residual = r.series["energy_residual"], work = r.series["external_work"];
  r.energy_residual = *std::max_element(residual.begin(), residual.end()) / *std::max_element(work.begin(), work.end());
}

inline Record fdem_record(const FdemSize& size = {}) {
  const Scene scene = fdem_scene(size);
  Record r;
  r.canonical_scene = canonical_text(scene);
  r.provenance = {
      {"build_id", build_info().build_id}, {"compiler", build_info().compiler}, {"flags", build_info().flags}, {"attempt", "1"}};
  r.key = job_key(r.canonical_scene, r.provenance["build_id"]);
  r.method = name_of(scene.method);
  r.material = material_name(scene);
  r.boundary_condition = "scene";
  r.cracks = scene.cracks;
  fill_frames(r.fdem, size, scene);
  r.series = fdem_series(size);
  judge_fdem(r);
  return r;
}

}  // namespace fracfarm::sample
