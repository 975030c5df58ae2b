// FDEM as the time loop sees it. A step: triangles from u(n) to u(n + 1) with the forces that are there, then joints and contact at the new
// place, so that between steps every force but the triangles' own is known. Refuses nothing: what does not fit was refused before.
#pragma once

#include <string>
#include <vector>

#include "solver/fdem/contact/contact.hpp"
#include "solver/fdem/kernels.hpp"
#include "solver/fdem/model.hpp"
#include "solver/law/edge.hpp"
#include "solver/simulation.hpp"

namespace fracfarm::fdem {

// W/m, with the velocities half a step before and after an instant.
struct Powers {
  double before, after;
};

// Chunks of triangles that one thread goes through, and which joints it leaves for when all have moved: those with a triangle of others.
struct Share {
  int begin, end;
  std::vector<int> springs{}, followed{};  // blocks; chunks
};

template <class Real>
struct EdgeNow {
  law::Ends<Real> opening;
  law::Line<Real> line;
};

template <class Real>
class Fdem final : public MeshSimulation {
 public:
  Fdem(Body body, const FdemSettings& settings, const Rules& rules, int threads, const Kernels<Real>& kernels = chosen_kernels<Real>());

  double stable_dt() const override;
  Result<void> start(double dt) override;
  Result<void> step(long long n, double dt) override;
  double mean_stress_zz() const override;
  SampleRow sample(long long n, double dt) const override;
  std::vector<float> stored_damage() const override;
  void take_damage_changes(std::vector<EdgeDamage>& changes) const override;
  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive, long long n, double dt) override;
  std::map<std::string, double> stage_seconds() const override;
  std::string kernel() const override;
  const TriangleMesh& mesh() const override { return body_.mesh; }
  std::vector<double> break_time() const override { return state_.break_time; }
  std::vector<unsigned char> break_mode() const override { return state_.break_mode; }

  const Plan& plan() const { return plan_; }
  const State<Real>& state() const { return state_; }

 private:
  View<Real> view() const;
  // Passes over all blocks, in chunks, whose sums are added in order (passes.cpp).
  AdvanceSums advance(double dt);
  TriangleSums measure(double dt) const;
  void join();
  AdvanceSums advance_and_join(double dt);
  void join_springs(const View<Real>& view, Share& share, int chunk) const;
  void join_followed(const View<Real>& view, Share& share, int chunk) const;
  void soften(double time);
  void put_rows();
  void tell_velocities(double time);
  void pull(double time);
  void move_as_one(double dt);
  void measure_cracks();
  void note_breaks(double time);
  void expose(int side);
  void expose_cracks_that_close();
  bool a_crack_closes() const;
  void watch_side(int side);
  void step_back(double dt);
  void remember_told() const;
  Powers power_of_told(double dt) const;
  double power_of_pulls(double time) const;
  BreakMode mode_of(int joint) const;
  float damage_at(std::size_t place) const;
  law::Ends<Real> side_at(int row) const;
  EdgeNow<Real> edge_now(int joint) const;
  void follow_what_softens();
  std::array<double, 4> reactions(double dt) const;

  Body body_;
  FdemSettings settings_;
  Rules rules_;
  int threads_;
  const Kernels<Real>& kernels_;
  Plan plan_;
  Model<Real> model_;
  State<Real> state_;
  mutable Scratch<Real> scratch_;
  Contact<Real> contact_;
  mutable double stable_dt_ = 0.0;
  double dt_ = 0.0;
};

}  // namespace fracfarm::fdem
