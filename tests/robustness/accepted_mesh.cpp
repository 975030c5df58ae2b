// The rules of accepted.hpp for runs on a mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/fdem/mesh/make_mesh.hpp"
#include "tests/robustness/accepted_mesh.hpp"

namespace fracfarm::robustness {
namespace {

using Index = std::size_t;

constexpr double ledger_limit = 0.02;
constexpr double rounding = 1e-9;  // of sums over a run
constexpr double area_limit = 1e-9;

const MeshLayout& mesh_of(const RunResult& r) { return std::get<MeshLayout>(r.layout); }
Index edges_of(const RunResult& r) { return mesh_of(r).mesh.edge_nodes.size(); }

struct Stored {
  const std::vector<float>* damage;
  std::string name;
};
std::vector<Stored> fields_of(const RunResult& r) {
  std::vector<Stored> fields{{&r.damage_initial, "initial"}, {&r.damage_failure, "failure"}};
  for (Index k = 0; k < r.frames.size(); ++k) fields.push_back({&r.frames[k].damage, fmt::format("frame {}", k)});
  return fields;
}

std::string sizes(const Scene&, const RunResult& r) {
  const MeshLayout& layout = mesh_of(r);
  const Index edges = edges_of(r);
  if (layout.break_time.size() != edges || layout.break_mode.size() != edges || layout.mesh.edge_kind.size() != edges)
    return "break times, modes or kinds of another size";
  for (const Stored& field : fields_of(r))
    if (field.damage->size() != edges) return fmt::format("{}: {} values on {} edges", field.name, field.damage->size(), edges);
  if (r.frames.empty() || r.frames.front().time != 0.0) return "no frame at t = 0";
  return r.series.rows() == 0 ? "no series" : "";
}

std::string finite(const Scene&, const RunResult& r) {
  for (const Stored& field : fields_of(r))
    if (!std::all_of(field.damage->begin(), field.damage->end(), [](float v) { return std::isfinite(v); })) return field.name + " is not";
  for (const Column& column : r.series.columns)
    if (!std::all_of(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); })) return column.name + " is not";
  for (const double value : {r.peak_stress, r.dt, r.energy_residual, r.judgement.confidence})
    if (!std::isfinite(value)) return "a number of the result is not";
  return {};
}

// What the gate promised.
std::string sound_mesh(const Scene& scene, const RunResult& r) {
  const TriangleMesh& mesh = mesh_of(r).mesh;
  double area = 0.0, least = INFINITY;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.nodes[static_cast<Index>(t[0])], &b = mesh.nodes[static_cast<Index>(t[1])],
               &c = mesh.nodes[static_cast<Index>(t[2])];
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    const double longest =
        std::max({std::hypot(b[0] - a[0], b[1] - a[1]), std::hypot(c[0] - b[0], c[1] - b[1]), std::hypot(a[0] - c[0], a[1] - c[1])});
    area += 0.5 * twice, least = std::min(least, twice / longest);
  }
  if (std::abs(area - scene.width * scene.height) > area_limit * scene.width * scene.height) return fmt::format("its area is {} m^2", area);
  const double allowed = fdem::smallest_height_allowed * scene.fdem.element_size;
  return least < allowed * (1.0 - 1e-9) ? fmt::format("a height of {} m, allowed {} m", least, allowed) : "";
}

std::string damage_in_range(const Scene&, const RunResult& r) {
  for (const Stored& field : fields_of(r))
    for (Index e = 0; e < field.damage->size(); ++e) {
      const float d = (*field.damage)[e];
      const bool crack = mesh_of(r).mesh.edge_kind[e] == EdgeKind::crack;
      if (crack ? d != 2.0F : !(d >= 0.0F && d <= 1.0F))
        return fmt::format("{}: {} on edge {}{}", field.name, d, e, crack ? ", a crack" : "");
    }
  return {};
}

std::string never_heals(const Scene&, const RunResult& r) {
  for (Index k = 1; k < r.frames.size(); ++k)
    for (Index e = 0; e < r.frames[k].damage.size(); ++e)
      if (r.frames[k].damage[e] < r.frames[k - 1].damage[e])
        return fmt::format("edge {} falls from {} to {} in frame {}", e, r.frames[k - 1].damage[e], r.frames[k].damage[e], k);
  return {};
}

// An edge has damage 1 from the moment at which it broke, to the step, and a mode if and only if it broke.
std::string breaks(const Scene&, const RunResult& r) {
  const MeshLayout& layout = mesh_of(r);
  const double last = static_cast<double>(r.steps) * r.dt, slack = 1e-6 * r.dt;
  for (Index e = 0; e < edges_of(r); ++e) {
    const double t = layout.break_time[e];
    if (std::isnan(t) != (layout.break_mode[e] == 0)) return fmt::format("edge {}: break time {} and mode {}", e, t, layout.break_mode[e]);
    if (!std::isnan(t) && !(t >= 0.0 && t <= last + slack)) return fmt::format("edge {} broke at {} s of {} s", e, t, last);
    if (!std::isnan(t) && layout.mesh.edge_kind[e] == EdgeKind::crack) return fmt::format("edge {} broke and was a crack", e);
    for (const Frame& frame : r.frames)
      if (layout.mesh.edge_kind[e] == EdgeKind::joint && (frame.damage[e] == 1.0F) != (t <= frame.time + slack))
        return fmt::format("edge {} has damage {} at {} s and broke at {} s", e, frame.damage[e], frame.time, t);
  }
  return {};
}

std::string times(const Scene& scene, const RunResult& r) {
  if (!(r.dt > 0.0) || r.steps < 1) return fmt::format("{} steps of {} s", r.steps, r.dt);
  const double last = scene.horizon + r.dt;
  for (Index k = 1; k < r.frames.size(); ++k)
    if (!(r.frames[k].time > r.frames[k - 1].time)) return fmt::format("frame {} is not after the one before", k);
  const auto time = r.series["step_time"];
  for (Index k = 1; k < time.size(); ++k)
    if (!(time[k] > time[k - 1])) return fmt::format("row {} of the series is not after the one before", k);
  return time.back() > last || r.frames.back().time > last ? "past the horizon" : "";
}

// A joint broke by then, or softened so far that a third of its strength is left.
bool gave_way(const RunResult& r, double time) {
  const MeshLayout& layout = mesh_of(r);
  for (Index e = 0; e < edges_of(r); ++e)
    if (layout.mesh.edge_kind[e] == EdgeKind::joint && (layout.break_time[e] <= time || r.damage_failure[e] >= 0.5F)) return true;
  return false;
}

std::string time_to_failure(const Scene& scene, const RunResult& r) {
  const auto& t = r.judgement.time_to_failure;
  if (r.judgement.verdict == Verdict::censored) return t ? "a censored run with a time to failure" : "";
  if (r.judgement.verdict != Verdict::failed) return "a verdict that no run may have";
  if (!t) return "failed at no time";
  if (r.judgement.rule != "five_step" && r.judgement.rule != "drop10") return "failed by the rule " + r.judgement.rule;
  if (!(*t > 0.0 && *t <= scene.horizon + r.dt)) return fmt::format("failed at {} s, horizon {} s", *t, scene.horizon);
  if (!gave_way(r, *t)) return "failed, and no joint gave way by then";
  if (r.judgement.rule != "drop10") return {};
  const auto time = r.series["step_time"], stress = r.series["stress_zz"];
  double peak = 0.0;
  for (Index k = 0; k < time.size() && time[k] <= *t; ++k) peak = std::max(peak, stress[k]);
  const auto row = std::find(time.begin(), time.end(), *t) - time.begin();
  if (static_cast<Index>(row) == time.size()) return "no row of the series at the time to failure";
  return stress[static_cast<Index>(row)] < 0.1 * peak ? "" : "the mean stress at drop10 is not below a tenth of its peak";
}

std::string peak(const Scene&, const RunResult& r) {
  const auto stress = r.series["stress_zz"];
  const double seen = std::max(0.0, *std::max_element(stress.begin(), stress.end()));
  return seen != r.peak_stress ? fmt::format("{} Pa, the series has {} Pa", r.peak_stress, seen) : "";
}

struct Ledger {
  double residual = 0.0, scale = 0.0, column_error = 0.0, free_excess = 0.0;
};

Ledger ledger_of(const RunResult& r) {
  const Series& s = r.series;
  const auto held = [&](Index k) {
    double sum = 0.0;
    for (const char* name :
         {"kinetic_energy", "elastic_energy", "plastic_energy", "fracture_energy", "viscous_energy", "contact_energy", "friction_energy"})
      if (const Column* column = s.find(name)) sum += column->values[k];
    return sum;
  };
  const auto free = [&](Index k) { return s["kinetic_energy"][k] + s["elastic_energy"][k]; };
  const double start = held(0) - s["external_work"][0], free_start = free(0) - s["external_work"][0];
  Ledger ledger;
  for (Index k = 0; k < s.rows(); ++k) {
    const double work = s["external_work"][k], residual = held(k) - work - start, steps = s["step_time"][k] / s["dt"][k];
    ledger.residual = std::max(ledger.residual, std::abs(residual) * std::pow(std::min(1.0, steps / 8.0), 2));
    ledger.scale = std::max({ledger.scale, std::abs(work), free(k)});
    ledger.column_error = std::max(ledger.column_error, std::abs(residual - (s["energy_residual"][k] - s["energy_residual"][0])));
    ledger.free_excess = std::max(ledger.free_excess, free(k) - free_start - 1.05 * work - 1e-6);
  }
  return ledger;
}

std::string ledger_closed(const Scene&, const RunResult& r) {
  const Ledger ledger = ledger_of(r);
  if (ledger.residual > ledger_limit * ledger.scale) return fmt::format("{:.3g} of {:.3g} J/m are missing", ledger.residual, ledger.scale);
  if (ledger.column_error > rounding * ledger.scale) return "the residual of the series is not that of its energies";
  return ledger.free_excess > rounding * ledger.scale ? fmt::format("{:.3g} J/m are free and were not brought", ledger.free_excess) : "";
}

constexpr AcceptanceRule table[]{
    {"sizes", sizes},
    {"finite", finite},
    {"sound_mesh", sound_mesh},
    {"damage_in_range", damage_in_range},
    {"never_heals", never_heals},
    {"breaks", breaks},
    {"times", times},
    {"time_to_failure", time_to_failure},
    {"peak", peak},
    {"ledger_closed", ledger_closed},
};

}  // namespace

std::span<const AcceptanceRule> mesh_acceptance_rules() { return table; }

double mesh_ledger_share(const RunResult& result) {
  const Ledger ledger = ledger_of(result);
  return ledger.scale > 0.0 ? ledger.residual / ledger.scale : 0.0;
}

}  // namespace fracfarm::robustness
