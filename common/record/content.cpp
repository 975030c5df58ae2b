#include "common/record/content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "common/base/text.hpp"
#include "common/failure/new_crack.hpp"
#include "common/record/damage_sweeps.hpp"
#include "common/record/rounding.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double psi_spacing = 1.0 / (1 << psi_fraction_bits);  // of stored values

struct Context {
  const Record& record;
  const PhaseFieldFrames& field;
  const std::optional<Scene>& scene;  // nothing where the text is not a scene
  bool damage_in_range;               // every damage field in [0, 1]: most rules about it need no second look
};

struct Rule {
  std::string_view name;
  std::string_view meaning;
  double limit;
  double (*value)(const Context&);
};

bool all_in_unit_range(const PhaseFieldFrames& field) {
  return in_unit_range(field.psi_initial) && in_unit_range(field.psi_failure) &&
         std::all_of(field.psi.begin(), field.psi.end(), [](const auto& frame) { return in_unit_range(frame); });
}

double not_finite(const Context& c) {
  std::size_t count = 0;
  const auto look = [&](const auto& values) {
    for (auto value : values) count += !std::isfinite(value);
  };
  if (!c.damage_in_range) {
    for (const auto& frame : c.field.psi) count += count_not_finite(frame);
    count += count_not_finite(c.field.psi_initial) + count_not_finite(c.field.psi_failure);
  }
  look(c.field.time), look(c.field.x), look(c.field.z);
  for (const Column& column : c.record.series.columns) look(column.values);
  look(std::array{c.record.peak_stress, c.record.energy_residual, c.record.judgement.confidence});
  return static_cast<double>(count);
}

double outside_unit_range(const Context& c) {
  if (c.damage_in_range) return 0.0;
  float worst = std::max(excursion(c.field.psi_initial), excursion(c.field.psi_failure));
  for (const auto& frame : c.field.psi) worst = std::max(worst, excursion(frame));
  return worst;
}

// psi_initial, the frames in order, and psi_failure among them where its time is known.
double healed(const Context& c) {
  float worst = 0.0f;
  const std::vector<float>* before = &c.field.psi_initial;
  for (const auto& frame : c.field.psi) worst = std::max(worst, largest_drop(*std::exchange(before, &frame), frame));
  const double at = c.record.judgement.time_to_failure.value_or(infinity);
  const auto next = std::upper_bound(c.field.time.begin(), c.field.time.end(), at) - c.field.time.begin();
  if (next > 0) worst = std::max(worst, largest_drop(c.field.psi[static_cast<std::size_t>(next - 1)], c.field.psi_failure));
  if (next < std::ssize(c.field.psi))
    worst = std::max(worst, largest_drop(c.field.psi_failure, c.field.psi[static_cast<std::size_t>(next)]));
  return worst;
}

double mask_below_one(const Context& c) {
  float worst = 0.0f;
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < c.field.mask_initial.size(); ++i)
    if (c.field.mask_initial[i]) held.push_back(i);
  const auto look = [&](const std::vector<float>& field) {
    for (std::size_t i : held) worst = std::max(worst, 1.0f - field[i]);
  };
  for (const auto& frame : c.field.psi) look(frame);
  look(c.field.psi_initial), look(c.field.psi_failure);
  const bool binary = std::all_of(c.field.mask_initial.begin(), c.field.mask_initial.end(), [](unsigned char m) { return m <= 1; });
  return binary ? worst : infinity;
}

double not_increasing(const std::vector<double>& times) {
  std::size_t count = !(times.front() >= 0.0);
  for (std::size_t i = 1; i < times.size(); ++i) count += !(times[i] > times[i - 1]);
  return static_cast<double>(count);
}

double frame_times(const Context& c) {
  if (!c.scene) return infinity;
  const auto rows = c.record.series["step_time"];
  double gap = 0.0;  // at least one time step: the last one may reach past the horizon
  for (std::size_t i = 1; i < rows.size(); ++i) gap = std::max(gap, rows[i] - rows[i - 1]);
  const bool starts = c.field.time.front() == 0.0, ends = c.field.time.back() <= c.scene->horizon * (1.0 + 1e-9) + gap;
  return not_increasing(c.field.time) + !starts + !ends;
}

double series_times(const Context& c) { return not_increasing(c.record.series.find("step_time")->values); }

// Largest distance between a node and where the scene's grid has it, over the cell size.
double grid_offset(const Context& c) {
  if (!c.scene) return infinity;
  const auto worst = [](const std::vector<double>& nodes, int cells, double length) {
    if (nodes.size() != static_cast<std::size_t>(cells) + 1) return infinity;
    double offset = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) offset = std::max(offset, std::abs(nodes[i] * cells / length - static_cast<double>(i)));
    return offset;
  };
  return std::max(worst(c.field.x, c.scene->phase_field.cells_x, c.scene->width),
                  worst(c.field.z, c.scene->phase_field.cells_z, c.scene->height));
}

double scene_differences(const Context& c) {
  if (!c.scene) return infinity;
  const Record& r = c.record;
  const auto& sample = c.scene->sample;
  return !(canonical_text(*c.scene) == r.canonical_scene) + !(name_of(c.scene->method) == r.method) +
         !(material_name(*c.scene) == r.material) + !((sample ? sample->load : "scene") == r.boundary_condition) +
         !((sample ? sample->id : 0) == r.sample_id) + !((sample ? sample->seed : 0) == r.pattern_seed) + !(c.scene->cracks == r.cracks);
}

double wrong_key(const Context& c) {
  const auto build = c.record.provenance.find("build_id");
  return build == c.record.provenance.end() || job_key(c.record.canonical_scene, build->second) != c.record.key;
}

double largest(const Series& series, std::string_view name) {
  double worst = 0.0;
  for (double value : series[name]) worst = std::max(worst, std::abs(value));
  return worst;
}

// What an energy error is measured by: the most that the loads brought, or that was there where they bring little.
double energy_scale(const Series& series) {
  const auto kinetic = series["kinetic_energy"], elastic = series["elastic_energy"];
  double most = largest(series, "external_work");
  for (std::size_t row = 0; row < series.rows(); ++row) most = std::max(most, kinetic[row] + elastic[row]);
  return most;
}

double share(double part, double whole) { return part == 0.0 ? 0.0 : whole > 0.0 ? part / whole : infinity; }

// A quasi-static run is exempt: in an unstable jump there is no inertia that would take up the energy.
double open_ledger(const Context& c) {
  if (c.scene && c.scene->phase_field.integrator == Integrator::quasi_static) return 0.0;
  const Series& s = c.record.series;
  const auto time = s["step_time"], residual = s["energy_residual"];
  const Column* dt = s.find("dt");
  double worst = 0.0;
  for (std::size_t row = 0; row < s.rows(); ++row)
    worst = std::max(worst, std::abs(residual[row]) * (dt ? ledger_weight(time[row] / dt->values[row]) : 1.0));
  return share(worst, energy_scale(s));
}

// The stored energy_residual is measured by the external work alone, and 0 where there was none.
double residual_difference(const Context& c) {
  const double work = largest(c.record.series, "external_work");
  return std::abs(c.record.energy_residual - (work > 0.0 ? largest(c.record.series, "energy_residual") / work : 0.0));
}

// energies - work - residual is what was there at the start, so it may not change from row to row.
double wrong_ledger(const Context& c) {
  static constexpr std::array<std::string_view, 8> held{"kinetic_energy",  "elastic_energy", "released_energy", "plastic_energy",
                                                        "fracture_energy", "viscous_energy", "contact_energy",  "friction_energy"};
  const Series& s = c.record.series;
  double low = infinity, high = -infinity;
  for (std::size_t row = 0; row < s.rows(); ++row) {
    double start = -s["external_work"][row] - s["energy_residual"][row];
    for (std::string_view name : held)
      if (const Column* column = s.find(name)) start += column->values[row];
    low = std::min(low, start);
    high = std::max(high, start);
  }
  return share(high - low, energy_scale(s));
}

// How far the stored peak lies from the series' own, which is sampled: at or above it, and not farther than the stress ever moves from row
// to row. Waves cross a body of fewer than eight cells between two rows, and a body may break before the second one: the series may then
// miss any peak.
double peak_difference(const Context& c) {
  const auto stress = c.record.series["stress_zz"];
  const double seen = std::max(0.0, *std::max_element(stress.begin(), stress.end()));
  if (seen > c.record.peak_stress * (1.0 + 1e-12)) return infinity;
  if (std::min(c.field.x.size(), c.field.z.size()) <= 8 || stress.size() < 4) return 0.0;
  double jump = 0.0;
  for (std::size_t row = 1; row < stress.size(); ++row) jump = std::max(jump, std::abs(stress[row] - stress[row - 1]));
  return share(std::max(0.0, c.record.peak_stress - seen - jump), c.record.peak_stress);
}

const FailureTime* candidate(const Record& record, std::string_view rule) {
  for (const FailureTime& time : record.failure_times)
    if (time.rule == rule) return &time;
  return nullptr;
}

// Between a stored candidate and the same criterion on the stored series, s.
double seconds_apart(const Context& c, std::string_view rule, const std::optional<double>& again) {
  const FailureTime* stored = candidate(c.record, rule);
  if (!stored) return 0.0;
  if (stored->time.has_value() != again.has_value()) return infinity;
  return again ? std::abs(*stored->time - *again) : 0.0;
}

// A drop that is not stored is one of a body with no new crack.
double drop_difference(const Context& c) {
  const auto again = stress_drop(c.record.series["step_time"], c.record.series["stress_zz"]);
  const FailureTime* stored = candidate(c.record, "stress_drop");
  if (!stored || stored->time || !again) return seconds_apart(c, "stress_drop", again);
  const auto after = std::upper_bound(c.field.time.begin(), c.field.time.end(), *again);
  const auto frame = static_cast<std::size_t>(after - c.field.time.begin());
  return frame > 0 && has_new_crack(c.field.psi[frame - 1], c.field.psi_initial) ? infinity : 0.0;
}

double pick_difference(const Context& c) {
  const Series& s = c.record.series;
  return seconds_apart(c, "five_step", five_step(s["step_time"], s["total_stress"], s["kinetic_energy"]));
}

bool is_loaded(const Scene& scene, Side side) {
  return std::any_of(scene.on(side).begin(), scene.on(side).end(), [](const SideLoad& load) {
    const bool moves =
        load.normal_velocity.value_or(0.0) != 0.0 || (load.tangential == Tangential::velocity && load.tangential_velocity != 0.0);
    return moves || (load.traction && ((*load.traction)[0] != 0.0 || (*load.traction)[1] != 0.0));
  });
}

// Left to right where top or bottom is loaded, bottom to top where left or right is; both where nothing is.
bool is_through(const Context& c, const std::vector<float>& psi, double threshold) {
  const std::vector<double> values(psi.begin(), psi.end());
  const FieldView view{values, static_cast<int>(c.field.x.size()), static_cast<int>(c.field.z.size())};
  std::vector<unsigned char> visited;
  const bool vertical = is_loaded(*c.scene, Side::top) || is_loaded(*c.scene, Side::bottom);
  const bool horizontal = is_loaded(*c.scene, Side::left) || is_loaded(*c.scene, Side::right);
  return ((vertical || !horizontal) && joins_sides(view, threshold, CrackDirection::left_right, visited)) ||
         ((horizontal || !vertical) && joins_sides(view, threshold, CrackDirection::bottom_top, visited));
}

// Fields that say otherwise than the through-crack time: one that should be through and is not, or is and should not be.
double through_crack_differences(const Context& c) {
  if (!c.scene) return infinity;
  const FailureTime* stored = candidate(c.record, "through_crack");
  const std::optional<double> time = stored ? stored->time : std::nullopt;
  const double surely = through_crack_threshold + psi_spacing;  // a field may have been rounded up across the threshold
  double count = 0.0;
  if (is_through(c, c.field.psi_initial, surely)) return time ? 0.0 : 1.0;  // cut from the start
  if (c.record.judgement.rule == "through_crack") count += !is_through(c, c.field.psi_failure, through_crack_threshold);
  if (!time) count += is_through(c, c.field.psi_failure, surely);
  const auto after = std::lower_bound(c.field.time.begin(), c.field.time.end(), time.value_or(infinity));
  if (after != c.field.time.begin())
    count += is_through(c, c.field.psi[static_cast<std::size_t>(after - c.field.time.begin() - 1)], surely);
  return count;
}

double judgement_differences(const Context& c) {
  const Judgement& stored = c.record.judgement;
  const Judgement again = judge(c.record.method, c.record.failure_times, stored.rule);
  return !(stored.verdict == again.verdict) + !(stored.time_to_failure == again.time_to_failure) + !(stored.rule == again.rule) +
         !(stored.confidence == again.confidence);
}

constexpr auto rules = std::to_array<Rule>({
    {"finite", "numbers that are not finite", 0.0, not_finite},
    {"damage_range", "largest excursion of damage from 0...1", 0.0, outside_unit_range},
    {"damage_growth", "largest drop of damage between instants", 4.0 * psi_spacing, healed},
    {"mask_held", "largest 1 - psi on a node of the initial cracks", 0.0, mask_below_one},
    {"frame_times", "frames out of order, before 0 or past the horizon", 0.0, frame_times},
    {"series_times", "series rows out of order or before 0", 0.0, series_times},
    {"grid", "largest distance of a node from the scene's grid, in cells", 1e-9, grid_offset},
    {"scene", "identity fields that differ from the canonical scene", 0.0, scene_differences},
    {"key", "1 where the key is not the digest of scene and build", 0.0, wrong_key},
    {"ledger_sum", "largest error of the energy ledger's sum over the largest work or energy", 1e-9, wrong_ledger},
    {"energy_closed", "largest energy residual over the largest work or energy, the first steps weighed less", energy_residual_limit,
     open_ledger},
    {"energy_residual", "difference of the stored energy residual from the series' own", 1e-12, residual_difference},
    {"peak_stress", "relative distance of the stored peak from the series' own", 0.1, peak_difference},
    {"stress_drop", "seconds to the stress drop of the series", 0.0, drop_difference},
    {"five_step", "seconds to the five-step pick of the series", 0.0, pick_difference},
    {"through_crack", "fields that contradict the time of the through crack", 0.0, through_crack_differences},
    {"judgement", "parts of the judgement that the candidates do not give", 0.0, judgement_differences},
});

std::string broken_fields(const PhaseFieldFrames& f) {
  const std::size_t nodes = f.x.size() * f.z.size();
  if (f.x.size() < 2 || f.z.size() < 2) return fmt::format("a grid of {} x {} nodes; at least 2 x 2", f.x.size(), f.z.size());
  if (f.time.empty()) return "no frames";
  if (f.psi.size() != f.time.size()) return fmt::format("{} frames of psi and {} times", f.psi.size(), f.time.size());
  for (const auto& frame : f.psi)
    if (frame.size() != nodes) return fmt::format("a frame of {} values on {} nodes", frame.size(), nodes);
  if (f.psi_initial.size() != nodes || f.psi_failure.size() != nodes || f.mask_initial.size() != nodes)
    return fmt::format("psi_initial, psi_failure, mask_initial have {}, {}, {} values on {} nodes", f.psi_initial.size(),
                       f.psi_failure.size(), f.mask_initial.size(), nodes);
  return {};
}

std::string broken_series(const Series& series) {
  if (series.rows() == 0 || series.columns.front().name != "step_time") return "the series has no rows or does not begin with step_time";
  std::set<std::string_view> names;
  for (const Column& column : series.columns) {
    if (column.values.size() != series.rows())
      return fmt::format("series column '{}' has {} rows, not {}", column.name, column.values.size(), series.rows());
    if (!names.insert(column.name).second) return fmt::format("two series columns are named '{}'", column.name);
  }
  for (const ColumnRow& row : series_table)
    if (row.required && !series.find(row.name)) return fmt::format("the series has no column '{}'", row.name);
  return {};
}

}  // namespace

std::string broken_shape(const Record& record) {
  if (std::string why = broken_fields(record.phase_field); !why.empty()) return why;
  if (std::string why = broken_series(record.series); !why.empty()) return why;
  return record.failure_times.empty() ? "no candidate times to failure" : "";
}

std::vector<ContentCheck> check_content(const Record& record) {
  std::optional<Scene> scene;
  if (Parsed<Scene> parsed = parse_scene(record.canonical_scene)) scene = std::move(*parsed);
  const Context context{record, record.phase_field, scene, all_in_unit_range(record.phase_field)};
  std::vector<ContentCheck> checks;
  for (const Rule& rule : rules) {
    double value = rule.value(context);
    if (std::isnan(value)) value = infinity;
    checks.push_back({rule.name, rule.meaning, value, rule.limit, value <= rule.limit});
  }
  return checks;
}

}  // namespace fracfarm
