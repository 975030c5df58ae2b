// The phase-field method with assembled sparse matrices, behind the time loop's seam: every option of a scene, in double. It runs what the
// row kernels do not do (Newmark, quasi-static, Gauss quadrature, J2) and is their second method where they do.
#pragma once

#include "solver/phasefield/assembled/step.hpp"
#include "solver/simulation.hpp"

namespace fracfarm::phasefield::assembled {

class Assembled final : public GridSimulation {
 public:
  // `prescription`: displacements that no scene can say, quasi-static only.
  explicit Assembled(const Scene& scene, Prescription prescription = {});

  double stable_dt() const override { return model_.stable_dt; }
  Result<void> start(double dt) override { return assembled::start(model_, initial_, state_, scratch_, dt); }
  Result<void> step(long long n, double dt) override { return assembled::step(model_, state_, scratch_, n, dt); }

  double mean_stress_zz() const override { return scratch_.stress.zz / area(); }
  bool crack_reaches(Side side, double threshold) const override;
  SampleRow sample(long long n, double dt) const override;

  int columns() const override { return model_.grid.columns; }
  int rows() const override { return model_.grid.rows; }
  void copy_damage(std::vector<double>& values) const override { values.assign(state_.psi.begin(), state_.psi.end()); }
  std::vector<float> stored_damage() const override { return {state_.psi.begin(), state_.psi.end()}; }
  void mark_cracked(double threshold, CrackMarks& marks) const override;
  std::vector<unsigned char> mask() const override { return model_.mask; }
  std::vector<double> x() const override;
  std::vector<double> z() const override;

  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive, long long n, double dt) override;

  std::map<std::string, double> stage_seconds() const override;
  std::string kernel() const override { return "assembled/double"; }

  Model& model() { return model_; }
  const Model& model() const { return model_; }
  State& state() { return state_; }
  const State& state() const { return state_; }
  Scratch& scratch() { return scratch_; }
  const Scratch& scratch() const { return scratch_; }
  // Force that holds a told displacement in its place, N/m along +axis.
  double reaction(int column, int row, Axis axis) const { return -scratch_.force[2 * model_.node(column, row) + (axis == Axis::z)]; }

 private:
  double area() const { return model_.grid.hx * model_.grid.cells_x() * model_.grid.hz * model_.grid.cells_z(); }
  double kinetic_energy(double dt) const;

  Initial initial_;
  Model model_;
  State state_;
  Scratch scratch_;
};

}  // namespace fracfarm::phasefield::assembled
