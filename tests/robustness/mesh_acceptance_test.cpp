// That the hostile scenes of FDEM could find something: each rule of acceptance refuses a result that breaks it.
#include <catch2/catch.hpp>
#include <limits>

#include "common/scene/pattern.hpp"
#include "tests/robustness/accepted_mesh.hpp"

using namespace fracfarm;
using namespace fracfarm::robustness;

namespace {

Scene plate() {
  Scene scene = sample_scene({find_material("shale"), find_load("uniaxial"), CrackSet::orthogonal, 1, 1, Method::fdem});
  scene.width = scene.height = 0.045;
  scene.cracks = {{0.0, 0.0225, 0.024, 0.0225}};
  for (const Side side : {Side::bottom, Side::top}) {
    SideLoad& load = scene.loads[static_cast<std::size_t>(side)].front();
    load.to = scene.width, load.normal_velocity = 5.0, load.ramp = 1e-5;
  }
  scene.horizon = 1e-4, scene.frame_interval = 1e-5, scene.stop = Stop::drop10;
  return scene;
}

const RunResult& sound() {
  static const RunResult result = solve(plate(), {}).value();
  return result;
}

MeshLayout& mesh_of(RunResult& r) { return std::get<MeshLayout>(r.layout); }

// The rule that a changed result breaks.
template <class Change>
std::string broken_by(Change change) {
  RunResult result = sound();
  change(result);
  const std::string words = broken_rule(plate(), result);
  return words.substr(0, words.find(':'));
}

double& at(RunResult& r, std::string_view name, std::size_t row) {
  for (Column& column : r.series.columns)
    if (column.name == name) return column.values.at(row);
  throw std::runtime_error("no such column");
}

std::size_t first_broken(RunResult& r) {
  std::size_t e = 0;
  while (!(mesh_of(r).break_time[e] <= r.frames.back().time)) ++e;
  return e;
}

}  // namespace

TEST_CASE("a sound run on a mesh is accepted, breaks, and its ledger is closed without being empty") {
  REQUIRE(sound().judgement.verdict == Verdict::failed);
  CHECK(broken_rule(plate(), sound()).empty());
  CHECK(ledger_share(sound()) > 0.0);
}

TEST_CASE("each rule of acceptance on a mesh refuses what breaks it") {
  CHECK(broken_by([](RunResult& r) { r.frames.back().damage.pop_back(); }) == "sizes");
  CHECK(broken_by([](RunResult& r) { at(r, "stress_xx", 3) = std::numeric_limits<double>::quiet_NaN(); }) == "finite");
  CHECK(broken_by([](RunResult& r) { mesh_of(r).mesh.nodes[7] = mesh_of(r).mesh.nodes[8]; }) == "sound_mesh");
  CHECK(broken_by([](RunResult& r) { r.damage_failure[7] = 1.001f; }) == "damage_in_range");
  CHECK(broken_by([](RunResult& r) {
          for (std::size_t e = 0; e < r.damage_failure.size(); ++e)
            if (mesh_of(r).mesh.edge_kind[e] == EdgeKind::crack) r.damage_failure[e] = 1.0f;
        }) == "damage_in_range");
  CHECK(broken_by([](RunResult& r) { r.frames.back().damage[first_broken(r)] = 0.0f; }) == "never_heals");
  CHECK(broken_by([](RunResult& r) { mesh_of(r).break_time[first_broken(r)] *= 0.5; }) == "breaks");
  CHECK(broken_by([](RunResult& r) { mesh_of(r).break_mode[first_broken(r)] = 0; }) == "breaks");
  CHECK(broken_by([](RunResult& r) { r.frames.back().time = 1.0; }) == "times");
  CHECK(broken_by([](RunResult& r) { r.judgement.time_to_failure.reset(); }) == "time_to_failure");
  CHECK(broken_by([](RunResult& r) { r.judgement = {Verdict::failed, r.series["step_time"][20], "drop10", 1.0}; }) == "time_to_failure");
  CHECK(broken_by([](RunResult& r) { r.peak_stress *= 0.9; }) == "peak");
  CHECK(broken_by([](RunResult& r) { at(r, "kinetic_energy", 40) *= 1.5; }) == "ledger_closed");
}

TEST_CASE("a run past its step's edge that sheds the energy into its joints breaks a rule even where its ledger closes") {
  CHECK(broken_by([](RunResult& r) {
          at(r, "kinetic_energy", 40) += 2.0 * at(r, "external_work", 40);
          at(r, "fracture_energy", 40) -= 2.0 * at(r, "external_work", 40);
        }) == "ledger_closed");
}

TEST_CASE("a body has failed only where a joint broke by then or has little of its strength left") {
  const auto failed_early = [](float softened) {
    return broken_by([&](RunResult& r) {
      std::size_t joint = 0;
      while (mesh_of(r).mesh.edge_kind[joint] != EdgeKind::joint) ++joint;
      r.judgement = {Verdict::failed, r.series["step_time"][20], "five_step", 1.0};
      r.damage_failure = r.damage_initial;
      r.damage_failure[joint] = softened;
    });
  };
  CHECK(failed_early(0.2f) == "time_to_failure");
  CHECK(failed_early(0.7f).empty());
}
