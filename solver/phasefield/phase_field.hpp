// The explicit phase-field method behind the time loop's seam, in double or float.
#pragma once

#include "solver/phasefield/step.hpp"
#include "solver/simulation.hpp"

namespace fracfarm::phasefield {

template <class Real>
class PhaseField final : public GridSimulation {
 public:
  PhaseField(const Scene& scene, const Kernels<Real>& kernels, const Rules& rules = {});

  double stable_dt() const override { return model_.stable_dt; }
  Result<void> start(double dt) override;
  Result<void> step(long long n, double dt) override;

  double mean_stress_zz() const override;
  bool crack_reaches(Side side, double threshold) const override;
  SampleRow sample(long long n, double dt) const override;

  int columns() const override { return model_.grid.columns; }
  int rows() const override { return model_.grid.rows; }
  void copy_damage(std::vector<double>& values) const override;
  std::vector<float> stored_damage() const override;
  void mark_cracked(double threshold, CrackMarks& marks) const override;
  std::vector<unsigned char> mask() const override { return model_.mask; }
  std::vector<double> x() const override;
  std::vector<double> z() const override;

  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive, long long n, double dt) override;

  std::map<std::string, double> stage_seconds() const override;
  std::string kernel() const override;

  Model& model() { return model_; }  // of tests
  State<Real>& state() { return state_; }
  Scratch<Real>& scratch() { return scratch_; }

 private:
  double area() const;

  const Kernels<Real>& kernels_;
  Initial initial_;
  Model model_;
  mutable State<Real> state_;  // kernels take one view of everything; sampling changes neither
  mutable Scratch<Real> scratch_;
};

}  // namespace fracfarm::phasefield
