#include "solver/phasefield/phase_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/phasefield/passes.hpp"

namespace fracfarm::phasefield {
namespace {

// Mean outward stress on the held nodes of each side, Pa.
template <class Real>
std::array<double, 4> reactions(const Model& model, const Scratch<Real>& scratch) {
  const double width = model.grid.hx * model.grid.cells_x(), height = model.grid.hz * model.grid.cells_z();
  std::array<double, 4> stress{};
  for (const Motion& motion : model.boundary.motions) {
    if (!motion.normal) continue;
    const bool vertical = motion.axis == Axis::x;
    const double outward = motion.side == Side::right || motion.side == Side::top ? 1.0 : -1.0;
    double force = 0.0;
    for (const std::size_t n : motion.nodes) force -= static_cast<double>((vertical ? scratch.fx : scratch.fz)[n]);
    stress[static_cast<std::size_t>(motion.side)] += outward * force / (vertical ? height : width);
  }
  return stress;
}

// Visits the nodes of a side.
template <class Visit>
void along_side(const Grid& grid, Side side, Visit visit) {
  const bool vertical = side == Side::left || side == Side::right;
  for (int k = 0; k < (vertical ? grid.rows : grid.columns); ++k) switch (side) {
      case Side::left:
        visit(grid.index(0, k));
        break;
      case Side::right:
        visit(grid.index(grid.columns - 1, k));
        break;
      case Side::bottom:
        visit(grid.index(k, 0));
        break;
      case Side::top:
        visit(grid.index(k, grid.rows - 1));
        break;
    }
}

std::vector<double> coordinates(int count, double h) {
  std::vector<double> at(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) at[static_cast<std::size_t>(k)] = k * h;
  return at;
}

// A field without its ghosts and pads.
template <class From, class To>
void copy_rows(const Grid& grid, const From* from, To* to) {
  for (int j = 0; j < grid.rows; ++j)
    std::copy_n(from + grid.index(0, j), grid.columns, to + static_cast<std::ptrdiff_t>(j) * grid.columns);
}

}  // namespace

template <class Real>
PhaseField<Real>::PhaseField(const Scene& scene, const Kernels<Real>& kernels, const Rules& rules)
    : kernels_(kernels),
      initial_(scene.initial),
      model_(build_model(scene)),
      state_(make_state<Real>(model_)),
      scratch_(make_scratch<Real>(model_)) {
  model_.rules = rules;
}

template <class Real>
Result<void> PhaseField<Real>::start(double dt) {
  return phasefield::start(model_, initial_, state_, scratch_, kernels_, dt);
}

template <class Real>
Result<void> PhaseField<Real>::step(long long n, double dt) {
  return phasefield::step(model_, state_, scratch_, kernels_, n, dt);
}

template <class Real>
double PhaseField<Real>::area() const {
  return model_.grid.hx * model_.grid.cells_x() * model_.grid.hz * model_.grid.cells_z();
}

template <class Real>
double PhaseField<Real>::mean_stress_zz() const {
  return state_.sums.stress.zz / area();
}

template <class Real>
bool PhaseField<Real>::crack_reaches(Side side, double threshold) const {
  bool found = false;
  along_side(model_.grid, side, [&](std::size_t n) { found = found || static_cast<double>(state_.psi[n]) > threshold; });
  return found;
}

template <class Real>
SampleRow PhaseField<Real>::sample(long long n, double dt) const {
  const SurfaceSum surface = phasefield::surface(model_, state_, scratch_, kernels_);
  SampleRow s;
  s.step_time = static_cast<double>(n) * dt;
  s.stress_xx = state_.sums.stress.xx / area();
  s.stress_zz = state_.sums.stress.zz / area();
  s.reaction = reactions(model_, scratch_);
  s.kinetic_energy = state_.sums.kinetic;
  s.elastic_energy = state_.whole ? state_.sums.elastic : phasefield::elastic_energy(model_, state_, scratch_, kernels_);
  s.released_energy = state_.released;
  s.surface_energy = surface.local + surface.gradient - state_.initial_surface;
  s.external_work = state_.external_work;
  s.energy_residual = energy_residual(s, state_.initial_energy);
  s.crack_length = surface.length;
  s.dt = dt;
  s.solver_iterations = state_.sweeps;
  return s;
}

// Since the last whole step only tiles whose psi moves can have changed.
// Since the last whole step only tiles whose psi moves can have changed.
template <class Real>
void PhaseField<Real>::mark_cracked(double threshold, CrackMarks& marks) const {
  const Grid& grid = model_.grid;
  if (marks.cracked.empty()) marks = {std::vector<unsigned char>(static_cast<std::size_t>(grid.columns * grid.rows)), {}, -1};
  marks.changed.clear();
  const long long before = std::exchange(marks.as_of, scratch_.solves);
  if (before == scratch_.solves) return;
  Real limit = static_cast<Real>(threshold);  // the largest number that is not above the threshold
  if (static_cast<double>(limit) > threshold) limit = std::nextafter(limit, -std::numeric_limits<Real>::infinity());
  const RunList& runs = before < scratch_.last_whole ? scratch_.tables.whole_rows : scratch_.moving;
  for (int j = 0; j < grid.rows; ++j)
    for (int k = runs.begin[static_cast<std::size_t>(j)]; k < runs.begin[static_cast<std::size_t>(j) + 1]; ++k) {
      const auto [begin, end] = runs.runs[static_cast<std::size_t>(k)];
      const Real* psi = state_.psi.data() + grid.index(begin, j);
      const int first = j * grid.columns + begin, count = std::min(end, grid.columns) - begin;
      unsigned char* cracked = marks.cracked.data() + first;
      if (!kernels_.differs(psi, limit, cracked, count)) continue;
      for (int i = 0; i < count; ++i)
        if (std::exchange(cracked[i], psi[i] > limit) != (psi[i] > limit)) marks.changed.push_back(first + i);
    }
}

template <class Real>
void PhaseField<Real>::copy_damage(std::vector<double>& values) const {
  values.resize(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()));
  copy_rows(model_.grid, state_.psi.data(), values.data());
}

template <class Real>
std::vector<float> PhaseField<Real>::stored_damage() const {
  std::vector<float> values(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()));
  copy_rows(model_.grid, state_.psi.data(), values.data());
  return values;
}

template <class Real>
std::vector<double> PhaseField<Real>::x() const {
  return coordinates(model_.grid.columns, model_.grid.hx);
}
template <class Real>
std::vector<double> PhaseField<Real>::z() const {
  return coordinates(model_.grid.rows, model_.grid.hz);
}

template <class Real>
void PhaseField<Real>::save(ArchiveWriter& archive) const {
  for (const Field<Real>* field : {&state_.ux, &state_.uz, &state_.vx, &state_.vz, &state_.psi, &state_.psi_previous})
    archive.put_array(*field);
  for (const Field<Real>& field : state_.history) archive.put_array(field);
  archive.put_array(state_.stored);
  for (const std::vector<unsigned char>* flags : {&state_.moves, &state_.yields}) archive.put_array(*flags);
  for (const double value : {state_.external_work, state_.released, state_.initial_energy, state_.initial_surface}) archive.put(value);
  archive.put(state_.sums);
  archive.put(state_.damages);
  archive.put(state_.whole);
  archive.put(state_.planned_sweeps);
  archive.put(state_.sweeps);
}

template <class Real>
bool PhaseField<Real>::load(ArchiveReader& archive, long long n, double dt) {
  for (Field<Real>* field : {&state_.ux, &state_.uz, &state_.vx, &state_.vz, &state_.psi, &state_.psi_previous})
    archive.get_array_like(*field);
  for (Field<Real>& field : state_.history) archive.get_array_like(field);
  archive.get_array_like(state_.stored);
  for (std::vector<unsigned char>* flags : {&state_.moves, &state_.yields}) archive.get_array_like(*flags);
  for (double* value : {&state_.external_work, &state_.released, &state_.initial_energy, &state_.initial_surface})
    *value = archive.get<double>();
  state_.sums = archive.get<StepSums>();
  state_.damages = archive.get<bool>();
  state_.whole = archive.get<bool>();
  state_.planned_sweeps = archive.get<int>();
  state_.sweeps = archive.get<long long>();
  if (archive.failed()) return false;
  refresh(model_, state_, scratch_, kernels_, n, dt);
  return true;
}

template <class Real>
std::map<std::string, double> PhaseField<Real>::stage_seconds() const {
  std::map<std::string, double> seconds;
  for (std::size_t k = 0; k < stage_names.size(); ++k) seconds[stage_names[k]] = scratch_.clock.seconds()[k];
  return seconds;
}

template <class Real>
std::string PhaseField<Real>::kernel() const {
  return std::string(kernels_.isa) + (sizeof(Real) == sizeof(double) ? "/double" : "/float");
}

template class PhaseField<double>;
template class PhaseField<float>;

}  // namespace fracfarm::phasefield
