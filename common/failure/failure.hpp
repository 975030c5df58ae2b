// Time-to-failure criteria: pure functions of series and fields. The solver stops by them, the worker judges the closed record by them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm {

enum class Verdict { failed, censored, rejected, diverged };
std::string_view name_of(Verdict verdict);
std::optional<Verdict> verdict_by_name(std::string_view name);

enum class CrackDirection { left_right, bottom_top };

inline constexpr double through_crack_threshold = 0.9;  // psi above it is open crack (seed paper's pictures; SCENES.md)
inline constexpr double stress_drop_fraction = 0.1;
inline constexpr double peak_prominence = 0.02;  // of a signal's range: what counts as a peak in the five-step pick

// A field of rows x columns nodes, row 0 at the bottom.
struct FieldView {
  std::span<const double> values;
  int columns = 0;
  int rows = 0;
};

// True where nodes with value > threshold join the two sides over 8-connected neighbours. `visited` is scratch of rows*columns, kept by the
// caller.
bool joins_sides(const FieldView& field, double threshold, CrackDirection direction, std::vector<unsigned char>& visited);

// First time after the peak at which stress < fraction * peak; nothing where the stress never peaked above 0 or never dropped. s.
std::optional<double> stress_drop(std::span<const double> time, std::span<const double> stress, double fraction = stress_drop_fraction);

// The seed's five-step pick on total stress and kinetic energy (seed paper, Methodology); nothing where a step finds no peak. s.
std::optional<double> five_step(std::span<const double> time, std::span<const double> total_stress, std::span<const double> kinetic_energy);

// One candidate time with the rule that gave it.
struct FailureTime {
  std::string rule;            // through_crack, stress_drop, five_step, drop10
  std::optional<double> time;  // s
};

struct Judgement {
  Verdict verdict = Verdict::censored;
  std::optional<double> time_to_failure;  // s
  std::string rule;                       // the criterion that gave it, or why there is none (horizon, wall_clock)
  double confidence = 0.0;                // in [0, 1], see judge()
};

// Picks by the method's own order of criteria (SCENES.md); where none of them was met, or the method has none, censored with `otherwise` as
// the rule. Phase field: through crack, else stress drop. FDEM: five-step pick, else drop10. A criterion that is not of the order never
// decides.
// Confidence is the mean agreement of the other candidates with the choice: shorter over longer time where both are there, 0.5 where
// only one of the two is, 1 where neither is; 0 where there is no other candidate. So 1 means that every criterion gives the same time.
Judgement judge(std::string_view method, std::span<const FailureTime> times, std::string_view otherwise);

// The longest of the candidate times less the shortest (s); nothing where fewer than two were met.
std::optional<double> disagreement(std::span<const FailureTime> times);

// A lost stress or a pick is a failure only of a body that broke by then, or soon after: joints that soften carry little for a while before
// they count as broken. `break_time` by edge (s), not a number where it never broke.
inline constexpr double broken_soon_after = 1.25;  // of the time
std::optional<double> of_broken_body(std::optional<double> time, std::span<const double> break_time);

}  // namespace fracfarm
