#include "tests/robustness/accepted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/robustness/accepted_mesh.hpp"

namespace fracfarm::robustness {
namespace {

const GridLayout& grid_of(const RunResult& r) { return std::get<GridLayout>(r.layout); }

bool on_a_mesh(const RunResult& r) { return std::holds_alternative<MeshLayout>(r.layout); }

constexpr double ledger_limit = 0.02;
constexpr double rounding = 1e-9;   // of sums over a run
constexpr double healing = 4.5e-4;  // psi is good to 2.5e-4, and records refuse 4 * 2^-13
constexpr double float_rounding = 1e-7;

std::size_t nodes_of(const Scene& scene) {
  return (static_cast<std::size_t>(scene.phase_field.cells_x) + 1) * (static_cast<std::size_t>(scene.phase_field.cells_z) + 1);
}

std::vector<const std::vector<float>*> fields_of(const RunResult& r) {
  std::vector<const std::vector<float>*> fields{&r.damage_initial, &r.damage_failure};
  for (const Frame& frame : r.frames) fields.push_back(&frame.damage);
  return fields;
}

std::string sizes(const Scene& scene, const RunResult& r) {
  const std::size_t nodes = nodes_of(scene);
  if (grid_of(r).x.size() * grid_of(r).z.size() != nodes)
    return fmt::format("{} x {} nodes, not {}", grid_of(r).x.size(), grid_of(r).z.size(), nodes);
  if (grid_of(r).mask.size() != nodes) return "mask of another size";
  if (r.frames.empty() || r.frames.front().time != 0.0) return "no frame at t = 0";
  for (const auto* field : fields_of(r))
    if (field->size() != nodes) return fmt::format("a field of {} values on {} nodes", field->size(), nodes);
  return r.series.rows() == 0 ? "no series" : "";
}

std::string finite(const Scene&, const RunResult& r) {
  for (const auto* field : fields_of(r))
    if (!std::all_of(field->begin(), field->end(), [](float v) { return std::isfinite(v); })) return "a damage field is not";
  for (const Column& column : r.series.columns)
    if (!std::all_of(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); })) return column.name + " is not";
  for (const double value : {r.peak_stress, r.dt, r.energy_residual, r.judgement.confidence})
    if (!std::isfinite(value)) return "a number of the result is not";
  return {};
}

std::string damage_in_range(const Scene&, const RunResult& r) {
  for (const auto* field : fields_of(r))
    for (const float psi : *field)
      if (!(psi >= 0.0f && psi <= 1.0f)) return fmt::format("psi = {}", psi);
  return {};
}

std::string cracks_held(const Scene&, const RunResult& r) {
  for (const auto* field : fields_of(r))
    for (std::size_t n = 0; n < field->size(); ++n)
      if (grid_of(r).mask[n] && (*field)[n] != 1.0f) return fmt::format("psi = {} on node {} of an initial crack", (*field)[n], n);
  return {};
}

std::string never_heals(const Scene&, const RunResult& r) {
  for (std::size_t k = 1; k < r.frames.size(); ++k)
    for (std::size_t n = 0; n < r.frames[k].damage.size(); ++n)
      if (r.frames[k].damage[n] < r.frames[k - 1].damage[n] - healing)
        return fmt::format("psi of node {} falls from {} to {} in frame {}", n, r.frames[k - 1].damage[n], r.frames[k].damage[n], k);
  return {};
}

std::string times(const Scene& scene, const RunResult& r) {
  if (!(r.dt > 0.0) || r.steps < 1) return fmt::format("{} steps of {} s", r.steps, r.dt);
  const double last = scene.horizon + r.dt;
  for (std::size_t k = 1; k < r.frames.size(); ++k)
    if (!(r.frames[k].time > r.frames[k - 1].time)) return fmt::format("frame {} is not after the one before", k);
  if (r.frames.back().time > last) return "a frame past the horizon";
  const auto time = r.series["step_time"];
  for (std::size_t k = 1; k < time.size(); ++k)
    if (!(time[k] > time[k - 1])) return fmt::format("row {} of the series is not after the one before", k);
  return time.back() > last ? "a row past the horizon" : "";
}

std::string time_to_failure(const Scene& scene, const RunResult& r) {
  const auto& t = r.judgement.time_to_failure;
  if (r.judgement.verdict == Verdict::censored) return t ? "a censored run with a time to failure" : "";
  if (r.judgement.verdict != Verdict::failed) return "a verdict that no run may have";
  if (!t) return "failed at no time";
  if (r.judgement.rule != "through_crack" && r.judgement.rule != "stress_drop") return "failed by the rule " + r.judgement.rule;
  return *t > 0.0 && *t <= scene.horizon + r.dt ? "" : fmt::format("failed at {} s, horizon {} s", *t, scene.horizon);
}

bool drives(const SideLoad& part) {
  return part.normal_velocity.value_or(0.0) != 0.0 || part.tangential_velocity != 0.0 ||
         (part.traction && ((*part.traction)[0] != 0.0 || (*part.traction)[1] != 0.0));
}

bool driven(const Scene& scene, Side a, Side b) {
  return std::any_of(scene.on(a).begin(), scene.on(a).end(), drives) || std::any_of(scene.on(b).begin(), scene.on(b).end(), drives);
}

class Union {
 public:
  explicit Union(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

// Sets of touching broken nodes that reach two opposite sides: (left and right, bottom and top).
std::pair<bool, bool> spans(const std::vector<float>& psi, std::size_t columns, std::size_t rows, double threshold) {
  Union sets(psi.size());
  const auto broken = [&](std::size_t n) { return static_cast<double>(psi[n]) >= threshold; };
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t n = j * columns + i;
      if (!broken(n)) continue;
      if (i + 1 < columns && broken(n + 1)) sets.join(n, n + 1);
      if (j + 1 < rows && broken(n + columns)) sets.join(n, n + columns);
      if (j + 1 < rows && i + 1 < columns && broken(n + columns + 1)) sets.join(n, n + columns + 1);
      if (j + 1 < rows && i > 0 && broken(n + columns - 1)) sets.join(n, n + columns - 1);
    }
  std::vector<unsigned char> reaches(psi.size(), 0);
  for (std::size_t n = 0; n < psi.size(); ++n) {
    if (!broken(n)) continue;
    const std::size_t i = n % columns, j = n / columns;
    unsigned char& at = reaches[sets.root(n)];
    if (i == 0) at |= 1;
    if (i + 1 == columns) at |= 2;
    if (j == 0) at |= 4;
    if (j + 1 == rows) at |= 8;
  }
  const auto any = [&](unsigned char both) {
    return std::any_of(reaches.begin(), reaches.end(), [&](unsigned char r) { return (r & both) == both; });
  };
  return {any(3), any(12)};
}

bool cut(const Scene& scene, const RunResult& r, const std::vector<float>& psi, double threshold) {
  const bool up = driven(scene, Side::top, Side::bottom), across = driven(scene, Side::left, Side::right);
  const auto [left_right, bottom_top] = spans(psi, grid_of(r).x.size(), grid_of(r).z.size(), threshold);
  return (left_right && (up || !across)) || (bottom_top && (across || !up));
}

std::string through_crack(const Scene& scene, const RunResult& r) {
  if (r.judgement.rule == "through_crack") {
    if (!cut(scene, r, r.damage_failure, 0.9 - float_rounding)) return "no path of psi >= 0.9 joins the sides";
    for (const Frame& frame : r.frames)
      if (frame.time > 0.0 && frame.time < *r.judgement.time_to_failure && cut(scene, r, frame.damage, 0.9001))
        return "a path was there before";
    return {};
  }
  return cut(scene, r, r.damage_failure, 0.9001) ? "a path is there and no through crack was seen" : "";
}

std::string stress_drop_time(const Scene&, const RunResult& r) {
  if (r.judgement.rule != "stress_drop") return {};
  bool breaks = false;
  for (std::size_t n = 0; n < r.damage_failure.size(); ++n) breaks = breaks || (r.damage_failure[n] > 0.9f && r.damage_initial[n] <= 0.9f);
  if (!breaks) return "the body is as whole as it was at the start";
  const auto time = r.series["step_time"], stress = r.series["stress_zz"];
  const double at = *r.judgement.time_to_failure;
  double peak = 0.0;
  bool low = false;
  for (std::size_t k = 0; k < time.size(); ++k) {
    peak = std::max(peak, stress[k]);
    low = low || (time[k] == at && stress[k] < 0.1 * peak);
  }
  return low ? "" : "the mean stress at the time to failure is not below a tenth of its peak";
}

std::string peak(const Scene&, const RunResult& r) {
  const auto stress = r.series["stress_zz"];
  const double seen = *std::max_element(stress.begin(), stress.end());
  return seen > r.peak_stress * (1.0 + rounding) + 1e-300 && seen > 0.0 ? fmt::format("{} Pa, the series has {} Pa", r.peak_stress, seen)
                                                                        : "";
}

struct Ledger {
  double residual, scale, column_error;  // the first steps weighed as the ledger's grammar says: an impact settles within eight
};

Ledger ledger_of(const RunResult& r) {
  const Series& s = r.series;
  const Column* plastic = s.find("plastic_energy");
  const auto held = [&](std::size_t k) {
    return s["kinetic_energy"][k] + s["elastic_energy"][k] + s["released_energy"][k] + (plastic ? plastic->values[k] : 0.0);
  };
  const double start = held(0) - s["external_work"][0];
  Ledger ledger{};
  for (std::size_t k = 0; k < s.rows(); ++k) {
    const double residual = held(k) - s["external_work"][k] - start;
    const double steps = s["step_time"][k] / s["dt"][k];
    ledger.residual = std::max(ledger.residual, std::abs(residual) * std::pow(std::min(1.0, steps / 8.0), 2));
    ledger.scale = std::max({ledger.scale, std::abs(s["external_work"][k]), s["kinetic_energy"][k] + s["elastic_energy"][k]});
    ledger.column_error = std::max(ledger.column_error, std::abs(residual - (s["energy_residual"][k] - s["energy_residual"][0])));
  }
  return ledger;
}

// In an unstable jump of a quasi-static run nothing takes up the energy.
std::string ledger_closed(const Scene& scene, const RunResult& r) {
  if (scene.phase_field.integrator == Integrator::quasi_static) return {};
  const Ledger ledger = ledger_of(r);
  if (ledger.residual > ledger_limit * ledger.scale) return fmt::format("{:.3g} of {:.3g} J/m are missing", ledger.residual, ledger.scale);
  if (ledger.column_error > rounding * ledger.scale) return "the residual of the series is not that of its energies";
  return {};
}

// Closed, but only because nothing happened? Loads that start at once must bring energy.
std::string something_happens(const Scene& scene, const RunResult& r) {
  double load = 0.0;
  for (const auto& side : scene.loads)
    for (const SideLoad& part : side) {
      const double share = part.ramp > 0.0 ? std::min(1.0, 0.5 * r.dt / part.ramp) : 1.0;
      load = std::max(load, share * std::max(std::abs(part.normal_velocity.value_or(0.0)), std::abs(part.tangential_velocity)));
      if (part.traction) load = std::max(load, share * 1e-9 * std::hypot((*part.traction)[0], (*part.traction)[1]));
    }
  return load > 1e-12 && ledger_of(r).scale == 0.0 ? "the body is loaded and no energy was ever in it" : "";
}

constexpr AcceptanceRule table[]{
    {"sizes", sizes},
    {"finite", finite},
    {"damage_in_range", damage_in_range},
    {"cracks_held", cracks_held},
    {"never_heals", never_heals},
    {"times", times},
    {"time_to_failure", time_to_failure},
    {"through_crack", through_crack},
    {"stress_drop", stress_drop_time},
    {"peak", peak},
    {"ledger_closed", ledger_closed},
    {"something_happens", something_happens},
};

}  // namespace

std::span<const AcceptanceRule> acceptance_rules() { return table; }

std::string broken_rule(const Scene& scene, const RunResult& result) {
  for (const AcceptanceRule& rule : on_a_mesh(result) ? mesh_acceptance_rules() : acceptance_rules())
    if (std::string words = rule.broken(scene, result); !words.empty()) return fmt::format("{}: {}", rule.name, words);
  return {};
}

double ledger_share(const RunResult& result) {
  if (on_a_mesh(result)) return mesh_ledger_share(result);
  const Ledger ledger = ledger_of(result);
  return ledger.scale > 0.0 ? ledger.residual / ledger.scale : 0.0;
}

}  // namespace fracfarm::robustness
