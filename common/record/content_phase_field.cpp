// Rules of the phase field's frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/failure/new_crack.hpp"
#include "common/record/content_rules.hpp"
#include "common/record/damage_sweeps.hpp"

namespace fracfarm::content {
namespace {

double not_finite(const Context& c) {
  const PhaseFieldFrames& f = c.record.phase_field;
  std::size_t count = content::count_not_finite(f.time) + content::count_not_finite(f.x) + content::count_not_finite(f.z);
  if (!c.damage_in_range) {
    for (const auto& frame : f.psi) count += fracfarm::count_not_finite(frame);
    count += fracfarm::count_not_finite(f.psi_initial) + fracfarm::count_not_finite(f.psi_failure);
  }
  return static_cast<double>(count) + series_not_finite(c);
}

double outside_unit_range(const Context& c) {
  if (c.damage_in_range) return 0.0;
  float worst = std::max(excursion(c.record.phase_field.psi_initial), excursion(c.record.phase_field.psi_failure));
  for (const auto& frame : c.record.phase_field.psi) worst = std::max(worst, excursion(frame));
  return worst;
}

double healed(const Context& c) {
  const PhaseFieldFrames& f = c.record.phase_field;
  return largest_healing(c, {f.time, f.psi, f.psi_initial, f.psi_failure});
}

double mask_below_one(const Context& c) {
  float worst = 0.0f;
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < c.record.phase_field.mask_initial.size(); ++i)
    if (c.record.phase_field.mask_initial[i]) held.push_back(i);
  const auto look = [&](const std::vector<float>& field) {
    for (std::size_t i : held) worst = std::max(worst, 1.0f - field[i]);
  };
  for (const auto& frame : c.record.phase_field.psi) look(frame);
  look(c.record.phase_field.psi_initial), look(c.record.phase_field.psi_failure);
  const bool binary = std::all_of(c.record.phase_field.mask_initial.begin(), c.record.phase_field.mask_initial.end(),
                                  [](unsigned char m) { return m <= 1; });
  return binary ? worst : infinity;
}

// Largest distance between a node and where the scene's grid has it, over the cell size.
double grid_offset(const Context& c) {
  if (!c.scene) return infinity;
  const auto worst = [](const std::vector<double>& nodes, int cells, double length) {
    if (nodes.size() != static_cast<std::size_t>(cells) + 1) return infinity;
    double offset = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) offset = std::max(offset, std::abs(nodes[i] * cells / length - static_cast<double>(i)));
    return offset;
  };
  return std::max(worst(c.record.phase_field.x, c.scene->phase_field.cells_x, c.scene->width),
                  worst(c.record.phase_field.z, c.scene->phase_field.cells_z, c.scene->height));
}

double times_of_frames(const Context& c) { return frame_times(c, c.record.phase_field.time); }

double peak_apart(const Context& c) {
  return peak_difference(c, static_cast<double>(std::min(c.record.phase_field.x.size(), c.record.phase_field.z.size())) - 1.0);
}

// A drop that is not stored is one of a body with no new crack.
double drop_difference(const Context& c) {
  const auto again = stress_drop(c.record.series["step_time"], c.record.series["stress_zz"]);
  const FailureTime* stored = candidate(c.record, "stress_drop");
  if (!stored || stored->time || !again) return seconds_apart(c, "stress_drop", again);
  const auto after = std::upper_bound(c.record.phase_field.time.begin(), c.record.phase_field.time.end(), *again);
  const auto frame = static_cast<std::size_t>(after - c.record.phase_field.time.begin());
  return frame > 0 && has_new_crack(c.record.phase_field.psi[frame - 1], c.record.phase_field.psi_initial) ? infinity : 0.0;
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
  const FieldView view{values, static_cast<int>(c.record.phase_field.x.size()), static_cast<int>(c.record.phase_field.z.size())};
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
  if (is_through(c, c.record.phase_field.psi_initial, surely)) return time ? 0.0 : 1.0;  // cut from the start
  if (c.record.judgement.rule == "through_crack") count += !is_through(c, c.record.phase_field.psi_failure, through_crack_threshold);
  if (!time) count += is_through(c, c.record.phase_field.psi_failure, surely);
  const auto after = std::lower_bound(c.record.phase_field.time.begin(), c.record.phase_field.time.end(), time.value_or(infinity));
  if (after != c.record.phase_field.time.begin())
    count += is_through(c, c.record.phase_field.psi[static_cast<std::size_t>(after - c.record.phase_field.time.begin() - 1)], surely);
  return count;
}

constexpr auto rules = std::to_array<Rule>({
    {"finite", "numbers that are not finite", 0.0, not_finite},
    {"damage_range", "largest excursion of damage from 0...1", 0.0, outside_unit_range},
    {"damage_growth", "largest drop of damage between instants", 4.0 * psi_spacing, healed},
    {"mask_held", "largest 1 - psi on a node of the initial cracks", 0.0, mask_below_one},
    {"frame_times", "frames out of order, before 0 or past the horizon", 0.0, times_of_frames},
    {"series_times", "series rows out of order or before 0", 0.0, series_times},
    {"grid", "largest distance of a node from the scene's grid, in cells", 1e-9, grid_offset},
    {"scene", "identity fields that differ from the canonical scene", 0.0, scene_differences},
    {"key", "1 where the key is not the digest of scene and build", 0.0, wrong_key},
    {"ledger_sum", "largest error of the energy ledger's sum over the largest work or energy", 1e-9, wrong_ledger},
    {"energy_closed", "largest energy residual over the largest work or energy, the first steps weighed less", energy_residual_limit,
     open_ledger},
    {"energy_residual", "difference of the stored energy residual from the series' own", 1e-12, residual_difference},
    {"peak_stress", "relative distance of the stored peak from the series' own", 0.1, peak_apart},
    {"stress_drop", "seconds to the stress drop of the series", 0.0, drop_difference},
    {"five_step", "seconds to the five-step pick of the series", 0.0, pick_difference},
    {"through_crack", "fields that contradict the time of the through crack", 0.0, through_crack_differences},
    {"judgement", "parts of the judgement that the candidates do not give", 0.0, judgement_differences},
});

}  // namespace

std::span<const Rule> phase_field_rules() { return rules; }

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

}  // namespace fracfarm::content
