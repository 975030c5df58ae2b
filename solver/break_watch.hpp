// The watch of a mesh: the stress drop and the five-step pick row by row, and the damage at each row, so that the field at either time is
// there when it is known.
#pragma once

#include "common/failure/failure_pick.hpp"
#include "solver/damage_history.hpp"
#include "solver/watch.hpp"

namespace fracfarm {

// A run that stops by drop10 goes on to this many times its time: that the stress stays down is seen.
inline constexpr double run_on_after_drop = 1.8;

class BreakWatch final : public Watch {
 public:
  explicit BreakWatch(const MeshSimulation& simulation) : simulation_(simulation) {}

  void after_step(double) override {}
  void at_row(const Series& series) override;
  bool wants_row(double) const override { return false; }
  bool is_over(Stop stop, double time) const override;

  std::vector<FailureTime> times(const Series& series) const override;
  std::vector<float> damage_at(std::string_view rule, const Series& series) const override;

  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive, const Series& series) override;

 private:
  void feed(const Series& series, std::size_t row);

  const MeshSimulation& simulation_;
  FailurePick pick_;
  DamageHistory history_;
  std::vector<EdgeDamage> changes_;  // since the last row, kept for its memory
};

}  // namespace fracfarm
