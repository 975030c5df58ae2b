// Rules of an FDEM run's frames: damage by edge, initial cracks, and the time at which each edge broke.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/record/content_rules.hpp"
#include "common/record/damage_sweeps.hpp"

namespace fracfarm::content {
namespace {

// Calls look(field, number of the frame); at the failure the number is the first frame after it.
template <class Look>
void each_frame(const FdemFrames& f, Look look) {
  look(f.damage_initial);
  for (const std::vector<float>& frame : f.damage) look(frame);
  look(f.damage_failure);
}

std::span<const unsigned char> cracks_of(const TriangleMesh& mesh) {
  return {reinterpret_cast<const unsigned char*>(mesh.edge_kind.data()), mesh.edge_kind.size()};
}

double not_finite(const Context& c) {
  const FdemFrames& f = c.record.fdem;
  std::size_t count = content::count_not_finite(f.time);
  for (const auto& node : f.mesh.nodes) count += content::count_not_finite(node);
  for (double broke : f.break_time) count += std::isinf(broke);
  if (!c.damage_in_range) each_frame(f, [&](const std::vector<float>& damage) { count += fracfarm::count_not_finite(damage); });
  return static_cast<double>(count) + series_not_finite(c);
}

double outside_range(const Context& c) {
  float worst = 0.0f;
  if (!c.damage_in_range)
    each_frame(c.record.fdem, [&](const std::vector<float>& damage) { worst = std::max(worst, joint_excursion(damage)); });
  return worst;
}

double healed(const Context& c) {
  const FdemFrames& f = c.record.fdem;
  return largest_healing(c, {f.time, f.damage, f.damage_initial, f.damage_failure});
}

double cracks_not_held(const Context& c) {
  const std::span<const unsigned char> cracks = cracks_of(c.record.fdem.mesh);
  if (std::any_of(cracks.begin(), cracks.end(), [](unsigned char kind) { return kind > 1; })) return infinity;
  std::size_t count = 0;
  each_frame(c.record.fdem, [&](const std::vector<float>& damage) { count += count_crack_contradictions(damage, cracks); });
  return static_cast<double>(count);
}

// An edge has a break mode where it has a break time, within the run, and only joints break.
bool breaks_well(const FdemFrames& f, std::size_t edge, double end) {
  const double broke = f.break_time[edge];
  const int mode = f.break_mode[edge];
  if (std::isnan(broke)) return mode == 0;
  return f.mesh.edge_kind[edge] == EdgeKind::joint && mode >= 1 && mode <= 3 && broke >= 0.0 && broke <= end;
}

// Edges at 1 before they broke, or not at 1 from then on, in any frame; and those whose break time or mode cannot be.
double break_contradictions(const Context& c) {
  const FdemFrames& f = c.record.fdem;
  std::size_t count = count_break_contradictions(f.damage_initial, c.broken_from, 0);
  for (std::size_t t = 0; t < f.damage.size(); ++t)
    count += count_break_contradictions(f.damage[t], c.broken_from, static_cast<std::int32_t>(t));
  const double end = std::max(f.time.back(), c.record.series["step_time"].back());
  const double failure = c.record.judgement.time_to_failure.value_or(end);
  for (std::size_t e = 0; e < f.break_time.size(); ++e)
    count += (f.damage_failure[e] == 1.0f) != (f.break_time[e] <= failure), count += !breaks_well(f, e, end);
  return static_cast<double>(count);
}

double times_of_frames(const Context& c) { return frame_times(c, c.record.fdem.time); }

double peak_apart(const Context& c) {
  return peak_difference(c, std::sqrt(static_cast<double>(c.record.fdem.mesh.triangles.size()) / 2.0));
}

// A time of the series counts where an edge had broken by then.
double candidate_apart(const Context& c, std::string_view rule, const std::optional<double>& of_series) {
  return candidate(c.record, rule) ? seconds_apart(c, rule, of_broken_body(of_series, c.record.fdem.break_time)) : infinity;
}

double drop_difference(const Context& c) {
  return candidate_apart(c, "drop10", stress_drop(c.record.series["step_time"], c.record.series["stress_zz"]));
}

double pick_difference(const Context& c) {
  const Series& s = c.record.series;
  return candidate_apart(c, "five_step", five_step(s["step_time"], s["total_stress"], s["kinetic_energy"]));
}

// The mesher may move a crack's end or a whole crack by half an element to part it from another, and twice where three meet.
constexpr double crack_limit = 1.0;

constexpr auto rules = std::to_array<Rule>({
    {"finite", "numbers that are not finite", 0.0, not_finite},
    {"mesh_domain", "largest distance of a node outside the scene's rectangle, in elements", 1e-9, outside_domain},
    {"mesh_triangles", "triangles that are not counter-clockwise", 0.0, turned_triangles},
    {"mesh_area", "relative difference of the triangles' area from the rectangle's", 1e-9, area_difference},
    {"mesh_edges", "edges that do not part the triangles they name, and inner sides of triangles without an edge", 0.0, unmatched_edges},
    {"mesh_cracks", "largest distance between the cracks of scene and mesh, in elements", crack_limit, crack_distance},
    {"damage_range", "largest distance of damage from 0...1 and from 2", 0.0, outside_range},
    {"damage_growth", "largest drop of damage between instants", 0.0, healed},
    {"cracks_held", "values that are 2 off the initial cracks or are not on them", 0.0, cracks_not_held},
    {"break_times", "edges whose break time, mode and damage contradict each other", 0.0, break_contradictions},
    {"frame_times", "frames out of order, before 0 or past the horizon", 0.0, times_of_frames},
    {"series_times", "series rows out of order or before 0", 0.0, series_times},
    {"scene", "identity fields that differ from the canonical scene", 0.0, scene_differences},
    {"key", "1 where the key is not the digest of scene and build", 0.0, wrong_key},
    {"ledger_sum", "largest error of the energy ledger's sum over the largest work or energy", 1e-9, wrong_ledger},
    {"energy_closed", "largest energy residual over the largest work or energy, the first steps weighed less", energy_residual_limit,
     open_ledger},
    {"energy_residual", "difference of the stored energy residual from the series' own", 1e-12, residual_difference},
    {"peak_stress", "relative distance of the stored peak from the series' own", 0.1, peak_apart},
    {"drop10", "seconds to the stress drop of the series", 0.0, drop_difference},
    {"five_step", "seconds to the five-step pick of the series", 0.0, pick_difference},
    {"judgement", "parts of the judgement that the candidates do not give", 0.0, judgement_differences},
});

bool within(std::span<const int> numbers, std::size_t count) {
  return std::all_of(numbers.begin(), numbers.end(), [&](int n) { return n >= 0 && static_cast<std::size_t>(n) < count; });
}

template <class Row>
bool all_within(const std::vector<Row>& rows, std::size_t count) {
  return std::all_of(rows.begin(), rows.end(), [&](const Row& row) { return within(row, count); });
}

std::string broken_mesh(const TriangleMesh& mesh) {
  const std::size_t nodes = mesh.nodes.size(), triangles = mesh.triangles.size(), edges = mesh.edge_nodes.size();
  if (nodes < 4 || triangles < 2 || edges < 1)
    return fmt::format("a mesh of {} nodes, {} triangles and {} edges; at least two triangles and the edge between them", nodes, triangles,
                       edges);
  if (mesh.edge_triangles.size() != edges || mesh.edge_kind.size() != edges)
    return fmt::format("{} edges with {} pairs of triangles and {} kinds", edges, mesh.edge_triangles.size(), mesh.edge_kind.size());
  if (!all_within(mesh.triangles, nodes)) return fmt::format("a triangle on a node that is not among the {}", nodes);
  if (!all_within(mesh.edge_nodes, nodes)) return fmt::format("an edge at a node that is not among the {}", nodes);
  if (!all_within(mesh.edge_triangles, triangles)) return fmt::format("an edge of a triangle that is not among the {}", triangles);
  return {};
}

}  // namespace

std::span<const Rule> fdem_rules() { return rules; }

std::string broken_fields(const FdemFrames& f) {
  if (std::string why = broken_mesh(f.mesh); !why.empty()) return why;
  const std::size_t edges = f.mesh.edge_nodes.size();
  if (f.time.empty()) return "no frames";
  if (f.damage.size() != f.time.size()) return fmt::format("{} frames of damage and {} times", f.damage.size(), f.time.size());
  for (const auto& frame : f.damage)
    if (frame.size() != edges) return fmt::format("a frame of {} values on {} edges", frame.size(), edges);
  if (f.damage_initial.size() != edges || f.damage_failure.size() != edges || f.break_time.size() != edges || f.break_mode.size() != edges)
    return fmt::format("damage_initial, damage_failure, break_time, break_mode have {}, {}, {}, {} values on {} edges",
                       f.damage_initial.size(), f.damage_failure.size(), f.break_time.size(), f.break_mode.size(), edges);
  return {};
}

}  // namespace fracfarm::content
