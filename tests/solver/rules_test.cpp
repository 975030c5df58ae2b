#include "solver/rules.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

#include "solver/phasefield/passes.hpp"
#include "solver/phasefield/phase_field.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

RunResult run(const Scene& scene, const Rules& rules = {}) {
  RunControl control;
  control.rules = rules;
  const auto result = solve(scene, control);
  REQUIRE(result);
  return *result;
}

double sum(std::span<const double> values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

// Pulled so slowly at first that nothing can damage for a while.
Scene ramped(SurfaceModel surface) {
  Scene scene = cracked("pbx", 24);
  for (const Side side : {Side::top, Side::bottom}) scene.loads[static_cast<std::size_t>(side)][0].ramp = 1e-3;
  scene.phase_field.surface = surface;
  scene.horizon = 6e-5;
  return scene;
}

void check_close(const RunResult& a, const RunResult& b, double bound = 1e-4) {
  CHECK(std::abs(a.steps - b.steps) <= 1);
  CHECK(a.peak_stress == Approx(b.peak_stress).epsilon(bound));
  CHECK(a.series["released_energy"].back() == Approx(b.series["released_energy"].back()).epsilon(5e-3).margin(1e-9));
}

}  // namespace

TEST_CASE("each rule left out changes a run by no more than the tolerance of its damage") {
  for (const char* material : {"pbx", "steel"}) {
    const Scene scene = cracked(material, 30);
    const RunResult with = run(scene);
    for (bool Rules::*rule : {&Rules::linear_until_damage, &Rules::plastic_where_it_yields, &Rules::sweep_where_it_moves}) {
      Rules rules;
      rules.*rule = false;
      check_close(with, run(scene, rules));
    }
  }
}

TEST_CASE("work where it moves changes the peak by less than 0.05 %") {
  for (const char* material : {"pbx", "steel"}) {
    const Scene scene = cracked(material, 64);
    Rules rules;
    rules.work_where_it_moves = false;
    check_close(run(scene), run(scene, rules), 5e-4);
  }
}

TEST_CASE("in light steps tiles that rest keep their damage and history, others go on, and the ledger closes in every step") {
  using namespace phasefield;
  for (const char* material : {"pbx", "steel"}) {
    PhaseField<double> run(cracked(material, 64), chosen_kernels<double>());
    const double dt = 0.9 * run.stable_dt();
    REQUIRE(run.start(dt));
    const Grid& grid = run.model().grid;
    long long rested = 0, moved = 0, light = 0;
    double worst = 0.0;
    for (int n = 0; n < 300; ++n) {
      const auto psi = run.state().psi;
      const auto history = run.state().history[0];
      REQUIRE(run.step(n, dt));
      const SampleRow row = run.sample(n + 1, dt);
      if (n > 100) worst = std::max(worst, std::abs(row.energy_residual) / row.external_work);
      if (run.state().whole) continue;
      ++light;
      for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
          const std::size_t at = grid.index(i, j);
          const bool moves = run.state().moves[static_cast<std::size_t>(j * grid.tiles() + i / lanes)] != 0;
          if (moves)
            moved += run.state().psi[at] != psi[at];
          else
            rested += run.state().psi[at] == psi[at] && run.state().history[0][at] == history[at] ? 1 : -1000000;
        }
    }
    INFO(material);
    CHECK(light > 150);
    CHECK(rested > 10000);
    CHECK(moved > 10000);
    CHECK(worst < 2e-3);
  }
}

TEST_CASE("a tile that yields while its damage rests has the force of its strain in every light step") {
  using namespace phasefield;
  const Kernels<double>& kernels = chosen_kernels<double>();
  PhaseField<double> run(cracked("steel", 64), kernels);
  Model& model = run.model();
  model.keeps_forces = true;
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  int yielding = 0, unseen = 0, compared = 0;
  for (int n = 0; n < 400; ++n) {
    REQUIRE(run.step(n, dt));
    if (run.state().whole || n < 100) continue;
    State<double> state = run.state();
    Scratch<double> scratch = run.scratch();
    state.whole = true, state.moves.assign(state.moves.size(), 1);
    strain(model, state, scratch, kernels);  // finds all that yield
    int unseen_now = 0;
    for (std::size_t t = 0; t < state.yields.size(); ++t) {
      if (state.yields[t] != does_yield) continue;
      yielding += !run.state().moves[t];
      unseen_now += !run.state().yields[t];
    }
    unseen += unseen_now;
    if (unseen_now > 0) continue;
    respond(model, state, scratch, kernels, 0.0);
    ++compared;
    CHECK(scratch.fx == run.scratch().fx);
    CHECK(scratch.fz == run.scratch().fz);
  }
  CHECK(yielding > 1000);
  CHECK(compared > 150);
  CHECK(100 * unseen < yielding);  // near yield is near enough
}

TEST_CASE("however many sweeps a step plans after the step before, every row's last correction is within the tolerance") {
  using namespace phasefield;
  PhaseField<double> run(cracked("pbx", 64), chosen_kernels<double>());
  const double dt = 0.9 * run.stable_dt();
  REQUIRE(run.start(dt));
  const int least = run.model().damage_sweeps;
  int more = 0, fewer = 0;
  for (int n = 0; n < 400; ++n) {
    const int planned = run.state().planned_sweeps;
    REQUIRE(run.step(n, dt));
    const std::vector<double>& change = run.scratch().change;
    CHECK(*std::max_element(change.begin(), change.end()) <= run.model().damage_tolerance);
    if (run.state().damages) CHECK(run.state().planned_sweeps >= least);
    more += run.state().planned_sweeps > std::max(planned, least), fewer += run.state().planned_sweeps < planned;
  }
  CHECK(more > 5);
  CHECK(fewer > 5);
}

TEST_CASE("crack marks are those of the damage, asked after every step, now and then, and after a restart, and say where they changed") {
  using namespace phasefield;
  const Scene scene = cracked("pbx", 64);
  PhaseField<double> run(scene, chosen_kernels<double>());
  const double dt = 0.9 * run.stable_dt(), threshold = 0.5;
  REQUIRE(run.start(dt));
  CrackMarks often, seldom;
  long long changes = 0, unchanged = 0, light = 0;
  std::vector<double> psi;
  const auto check = [&](CrackMarks& marks) {
    const std::vector<unsigned char> before = marks.cracked;
    run.mark_cracked(threshold, marks);
    run.copy_damage(psi);
    bool right = marks.cracked.size() == psi.size();
    for (std::size_t n = 0; n < psi.size() && right; ++n) right = marks.cracked[n] == (psi[n] > threshold);
    CHECK(right);
    std::vector<int> changed;
    for (std::size_t n = 0; n < psi.size(); ++n)
      if ((before.empty() ? 0 : before[n]) != marks.cracked[n]) changed.push_back(static_cast<int>(n));
    CHECK(marks.changed == changed);
    ++(changed.empty() ? unchanged : changes);
  };
  for (int n = 0; n < 400; ++n) {
    REQUIRE(run.step(n, dt));
    light += !run.state().whole;
    check(often);
    if (n % 7 == 0) check(seldom);
    if (n != 250) continue;
    ArchiveWriter archive;
    run.save(archive);
    ArchiveReader reader(archive.bytes());
    REQUIRE(run.load(reader, n + 1, dt));
    check(often);
  }
  CHECK(light > 100);
  CHECK(changes > 30);
  CHECK(unchanged > 30);
}

TEST_CASE("steps are linear until something could damage, and the run is the same") {
  for (const SurfaceModel surface : {SurfaceModel::at2, SurfaceModel::at1}) {
    const Scene scene = ramped(surface);
    Rules rules;
    rules.linear_until_damage = false;
    const RunResult with = run(scene), without = run(scene, rules);
    CHECK(sum(with.series["solver_iterations"]) < sum(without.series["solver_iterations"]));
    REQUIRE(with.damage_failure.size() == without.damage_failure.size());
    for (std::size_t n = 0; n < with.damage_failure.size(); ++n)
      CHECK(std::abs(with.damage_failure[n] - without.damage_failure[n]) < 1e-3f);
    CHECK(with.peak_stress == Approx(without.peak_stress).epsilon(5e-4));  // whole steps come at the same n, but judge other tiles
  }
}
