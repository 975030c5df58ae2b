// The times to failure of a run that still goes on: rows in, drop10 and the five-step pick of the rows so far out, and whether more rows
// can be expected to leave the pick alone. Both are exactly what drop10 = stress_drop() and five_step() give on the same rows.
//
// What later rows can do to a pick. Prominences only grow as rows are added, and so does what is asked of them, 2 % of the range. So while
//   (a) no signal leaves the range that it had and (b) the kinetic energy falls nowhere as steeply as behind the key peak,
// the pick is final as soon as it exists and no weaker peak between the key peak and its drop can still become prominent. That is tested
// exactly. (a) and (b) are the future's and cannot be: a body that is pulled on
// may load up again. The pick is taken as settled when, beside that, the stress was lost (drop10 is there) and the last settling_wait of
// the pick's time were quiet: kinetic energy falling nowhere faster than settling_quiet of the key's drop, the stress below settling_quiet
// of its largest magnitude.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace fracfarm {

inline constexpr double settling_wait = 0.25;  // of the pick's time
inline constexpr double settling_quiet = 0.5;

// Every run has these; a study tries others.
struct Settling {
  double wait = settling_wait, quiet = settling_quiet;
};

struct SeriesRow {
  double time = 0.0;            // s, rising
  double mean_stress = 0.0;     // Pa, for drop10
  double total_stress = 0.0;    // Pa, for the pick
  double kinetic_energy = 0.0;  // J/m
};

// The exact part: there is a pick, and later rows that keep (a) and (b) cannot move it.
bool firm_pick(std::span<const double> time, std::span<const double> total_stress, std::span<const double> kinetic_energy);

// Depends on the rows alone: a restart feeds them again. Looking costs as much as five_step(), and is done in at most every 64th part of
// the rows.
class FailurePick {
 public:
  explicit FailurePick(Settling settling = {}) : settling_(settling) {}
  void add(const SeriesRow& row);

  std::optional<double> drop10() const { return drop10_; }       // s
  std::optional<double> five_step() const;                       // s, of the rows so far; looks at all of them
  std::optional<double> settled_at() const { return settled_; }  // s, of the row at which the pick was taken as settled
  bool settled() const { return settled_.has_value(); }

 private:
  void look();
  void look_again_later();
  std::size_t quiet_since(std::size_t pick, double rate) const;

  Settling settling_;
  std::vector<double> time_, total_stress_, kinetic_energy_;
  double highest_stress_ = 0.0;
  std::optional<double> drop10_, settled_;
  std::size_t next_look_ = 8;  // rows
  double next_look_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace fracfarm
