#include "solver/phasefield/assembled/assembled.hpp"

#include <algorithm>
#include <utility>

#include "solver/phasefield/assembled/points.hpp"

namespace fracfarm::phasefield::assembled {
namespace {

// Mean outward stress on the held nodes of each side, Pa.
std::array<double, 4> reactions(const Model& model, const Scratch& scratch) {
  const double width = model.grid.hx * model.grid.cells_x(), height = model.grid.hz * model.grid.cells_z();
  std::array<double, 4> stress{};
  for (const Motion& motion : model.boundary.motions) {
    if (!motion.normal) continue;
    const double outward = motion.side == Side::right || motion.side == Side::top ? 1.0 : -1.0;
    double force = 0.0;
    for (const std::size_t n : motion.nodes) force -= scratch.force[static_cast<Eigen::Index>(2 * n + (motion.axis == Axis::z))];
    stress[static_cast<std::size_t>(motion.side)] += outward * force / (motion.axis == Axis::x ? height : width);
  }
  return stress;
}

std::vector<double> coordinates(int count, double h) {
  std::vector<double> at(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) at[static_cast<std::size_t>(k)] = k * h;
  return at;
}

}  // namespace

Assembled::Assembled(const Scene& scene, Prescription prescription)
    : initial_(scene.initial),
      model_(build_model(scene, std::move(prescription))),
      state_(make_state(model_)),
      scratch_(make_scratch(model_)) {}

void Assembled::mark_cracked(double threshold, CrackMarks& marks) const {
  marks.cracked.resize(static_cast<std::size_t>(state_.psi.size()));
  marks.changed.clear();
  for (std::size_t node = 0; node < marks.cracked.size(); ++node) {
    const unsigned char mark = state_.psi[static_cast<Eigen::Index>(node)] > threshold;
    if (std::exchange(marks.cracked[node], mark) != mark) marks.changed.push_back(static_cast<int>(node));
  }
}

bool Assembled::crack_reaches(Side side, double threshold) const {
  const bool vertical = side == Side::left || side == Side::right;
  const int last = side == Side::right ? columns() - 1 : side == Side::top ? rows() - 1 : 0;
  for (int k = 0; k < (vertical ? rows() : columns()); ++k)
    if (state_.psi[vertical ? model_.node(last, k) : model_.node(k, last)] > threshold) return true;
  return false;
}

// Explicit velocities are half a step back: the same kick brings them to now.
double Assembled::kinetic_energy(double dt) const {
  if (model_.settings.integrator != Integrator::explicit_central) return 0.5 * model_.mass.dot(state_.v.cwiseAbs2());
  double sum = 0.0;
  for (std::size_t d = 0; d < model_.equation.size(); ++d) {
    const auto at = static_cast<Eigen::Index>(d);
    const double v = state_.v[at] + (model_.equation[d] >= 0 ? 0.5 * dt * scratch_.force[at] / model_.mass[at] : 0.0);
    sum += 0.5 * model_.mass[at] * v * v;
  }
  return sum;
}

SampleRow Assembled::sample(long long n, double dt) const {
  const SurfaceSum crack = surface(model_, state_.psi);
  SampleRow s;
  s.step_time = static_cast<double>(n) * dt;
  s.stress_xx = scratch_.stress.xx / area();
  s.stress_zz = scratch_.stress.zz / area();
  s.reaction = reactions(model_, scratch_);
  s.kinetic_energy = kinetic_energy(dt);
  s.elastic_energy = elastic_energy(model_, scratch_);
  s.released_energy = state_.released;
  s.plastic_energy = state_.plastic_work;
  s.surface_energy = crack.energy - state_.initial_surface;
  s.external_work = state_.external_work;
  s.energy_residual = energy_residual(s, state_.initial_energy);
  s.crack_length = crack.length;
  s.dt = dt;
  s.solver_iterations = state_.iterations;
  return s;
}

std::vector<double> Assembled::x() const { return coordinates(columns(), model_.grid.hx); }
std::vector<double> Assembled::z() const { return coordinates(rows(), model_.grid.hz); }

void Assembled::save(ArchiveWriter& archive) const {
  for (const Vector* field : {&state_.u, &state_.v, &state_.a, &state_.psi, &state_.psi_previous})
    archive.put_array(std::vector<double>(field->begin(), field->end()));
  archive.put_array(state_.history);
  archive.put_array(state_.plastic);
  for (const double value :
       {state_.external_work, state_.released, state_.plastic_work, state_.initial_energy, state_.initial_surface, state_.largest_force})
    archive.put(value);
  archive.put(state_.iterations);
  archive.put(state_.passes);
  scratch_.displacement_solver.save(archive);
}

bool Assembled::load(ArchiveReader& archive, long long n, double dt) {
  for (Vector* field : {&state_.u, &state_.v, &state_.a, &state_.psi, &state_.psi_previous}) {
    std::vector<double> values(static_cast<std::size_t>(field->size()));
    archive.get_array_like(values);
    std::copy(values.begin(), values.end(), field->begin());
  }
  archive.get_array_like(state_.history);
  archive.get_array_like(state_.plastic);
  for (double* value : {&state_.external_work, &state_.released, &state_.plastic_work, &state_.initial_energy, &state_.initial_surface,
                        &state_.largest_force})
    *value = archive.get<double>();
  state_.iterations = archive.get<long long>();
  state_.passes = archive.get<long long>();
  if (!scratch_.displacement_solver.load(archive, scratch_.stiffness.lower()) || archive.failed()) return false;
  refresh(model_, state_, scratch_, n, dt);
  return true;
}

std::map<std::string, double> Assembled::stage_seconds() const {
  std::map<std::string, double> seconds;
  for (std::size_t k = 0; k < stage_names.size(); ++k) seconds[stage_names[k]] = scratch_.clock.seconds()[k];
  return seconds;
}

}  // namespace fracfarm::phasefield::assembled
