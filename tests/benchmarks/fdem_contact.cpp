// FDEM contact on a run stopped in the middle of breaking: a step of forces, and the search by cells.
#include <benchmark/benchmark.h>

#include <cmath>

#include "common/material/material.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/fdem.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "solver/fdem/solver.hpp"

namespace fracfarm::benchmarks {
namespace {

using namespace fdem;

// Shale at 200 us: cracks through, fragments on their way, about 270 broken edges beside those of the initial cracks.
struct StoppedRun {
  std::unique_ptr<MeshSimulation> simulation;
  const Fdem<float>* solver = nullptr;
  double dt = 0.0;
  std::vector<int> exposed;
  std::vector<float> rows, moved;  // displacement rows, and how far a step takes them

  StoppedRun() {
    const Scene scene = sample_scene({find_material("shale"), find_load("uniaxial"), CrackSet::orthogonal, 2026, 2, Method::fdem});
    simulation = make_fdem(scene, mesh_of(scene).value().value().mesh);
    solver = &dynamic_cast<const Fdem<float>&>(*simulation);
    dt = 0.7 * simulation->stable_dt();
    if (!simulation->start(dt)) return;
    for (long long n = 0; static_cast<double>(n) * dt < 200e-6; ++n)
      if (!simulation->step(n, dt)) return;
    const Plan& plan = solver->plan();
    exposed = plan.crack_sides;
    for (std::size_t joint = 0; joint < plan.edge_of.size(); ++joint) {
      if (plan.edge_of[joint] < 0 || std::isnan(solver->state().break_time[static_cast<std::size_t>(plan.edge_of[joint])])) continue;
      exposed.push_back(plan.left_side[joint]), exposed.push_back(plan.right_side[joint]);
    }
    rows.resize(plan.corner_rows.size()), moved.resize(plan.corner_rows.size());
    for (int slot = 0; slot < plan.slots; ++slot)
      for (int k = 0; k < 4; ++k)
        for (int axis = 0; axis < 2; ++axis) {
          const std::size_t at = static_cast<std::size_t>(slot * row_size + 2 * k + axis), from = at_corner(3 * slot + k % 3, axis);
          rows[at] = solver->state().u[from], moved[at] = static_cast<float>(dt) * solver->state().v[from];
        }
  }
  Contact<float> contact() const {
    const Plan& plan = solver->plan();
    Contact<float> made(plan.corner_rows, plan.neighbour, plan.contact);
    for (const int side : exposed) made.expose(side, false);
    return made;
  }
};

const StoppedRun& stopped_run() {
  static const StoppedRun run;
  return run;
}

// Steps to and fro over the motion of 50 steps around where the run stopped. Moving the rows of the exposed triangles is timed with it,
// about a tenth of the whole.
void step(benchmark::State& state) {
  const StoppedRun& run = stopped_run();
  Contact<float> contact = run.contact();
  std::vector<float> rows = run.rows, force(run.rows.size(), 0.0F);
  double touches = 0.0, steps = 0.0;
  int at = 0, way = 1;
  for (auto _ : state) {
    for (const int side : run.exposed) {
      const std::size_t row = static_cast<std::size_t>(side / 3) * row_size;
      for (std::size_t c = row; c < row + row_size; ++c) rows[c] = run.rows[c] + static_cast<float>(at) * run.moved[c];
    }
    contact.add_forces(rows.data(), force.data());
    if (at + way < -25 || at + way > 25) way = -way;
    at += way;
    touches += static_cast<double>(contact.touches().size()), steps += 1.0;
  }
  state.counters["sides"] = static_cast<double>(contact.surface().sides().size());
  state.counters["near_pairs"] = static_cast<double>(contact.near_pairs().pairs().size());
  state.counters["touches"] = touches / steps;
  state.counters["selections"] = static_cast<double>(contact.near_pairs().selections()) / steps;
}

struct Placed {
  Surface surface;
  std::vector<SideNow> now;
};

Placed placed(const StoppedRun& run) {
  Placed all{Surface(run.solver->plan().corner_rows, run.solver->plan().neighbour), {}};
  for (const int side : run.exposed) all.surface.expose({side, 0});
  all.surface.commit();
  for (const SideNow& place : all.surface.undeformed()) {
    const float* u = &run.rows[static_cast<std::size_t>(all.surface.rows()[all.now.size()])];
    all.now.push_back({place.ax + u[0], place.az + u[1], place.bx + u[2], place.bz + u[3]});
  }
  return all;
}

void search(benchmark::State& state) {
  const Placed all = placed(stopped_run());
  CellSearch cells;
  std::vector<SidePair> pairs;
  const double margin = 0.1 * all.surface.mean_length();
  for (auto _ : state) cells.find({all.surface.sides(), all.now, margin}, pairs);
  state.counters["sides"] = static_cast<double>(all.now.size());
  state.counters["far_pairs"] = static_cast<double>(pairs.size());
}

// One edge more, joined to lists that hold the others.
void admit(benchmark::State& state) {
  const Placed all = placed(stopped_run());
  CellSearch cells;
  std::vector<SidePair> known, pairs;
  const double margin = 0.1 * all.surface.mean_length();
  const std::size_t first = all.now.size() - 2;
  cells.find({std::span(all.surface.sides()).first(first), std::span(all.now).first(first), margin}, known);
  for (auto _ : state) {
    pairs = known;
    CellSearch::add({all.surface.sides(), all.now, margin}, first, pairs);
  }
}

BENCHMARK(step)->Name("fdem_contact/step")->Unit(benchmark::kMicrosecond);
BENCHMARK(search)->Name("fdem_contact/search")->Unit(benchmark::kMicrosecond);
BENCHMARK(admit)->Name("fdem_contact/admit")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace fracfarm::benchmarks
