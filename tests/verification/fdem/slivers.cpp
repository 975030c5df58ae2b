// FD-15: tiny elements, injected in three ways. Whatever comes in, what goes on has no height below the gate, or does not go on; and where
// the gate is gone round, the bound of the step or the alarm of the run says so.
#include <fmt/format.h>

#include <cmath>

#include "common/base/random.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/fdem.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "solver/fdem/mesh/msh_text.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/squeeze.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/sample_cases.hpp"

namespace fracfarm::verification {
namespace {

constexpr double h = 0.003;  // m
constexpr double allowed = fdem::smallest_height_allowed * h;

// Pairs of cracks that nearly touch: beside each other, end to side, crossing at a small angle, end to edge of the body.
std::vector<Segment> near_pair(RandomStream& random, double width) {
  const double x = random.uniform(0.25, 0.6) * width, z = random.uniform(0.25, 0.75) * width, length = random.uniform(0.1, 0.3) * width;
  const double gap = h * std::pow(10.0, random.uniform(-6.0, 0.0));
  const Segment first{x, z, x + length, z};
  switch (random.integer(0, 3)) {
    case 0:
      return {first, {x + 0.3 * length, z + gap, x + 1.2 * length, z + gap}};
    case 1:
      return {first, {x + 0.5 * length, z + gap, x + 0.5 * length, z + gap + length}};
    case 2:
      return {first, {x, z - gap, x + length, z + gap}};
    default:
      return {{gap, z, length, z}, {x, gap, x, length}};
  }
}

struct Injected {
  int made = 0, refused = 0, wrong = 0;
};

Injected inject_cracks(Desk& desk, int count) {
  Injected counts;
  RandomStream random(15, 0, 0);
  for (int k = 0; k < count; ++k) {
    desk.progress("cracks that nearly touch", 0.7 * k / count);
    fdem::MeshChoice choice;
    choice.width = choice.height = 0.06;
    choice.cracks = near_pair(random, choice.width);
    const fdem::MeshResult mesh = fdem::make_mesh(choice);
    if (!mesh)
      ++counts.refused, counts.wrong += mesh.error().empty();
    else
      ++counts.made, counts.wrong += studies::smallest_height(mesh->mesh) < allowed * (1.0 - 1e-9);
  }
  return counts;
}

fdem::MeshChoice plate() {
  fdem::MeshChoice choice;
  choice.width = choice.height = 0.06;
  choice.cracks = {{0.015, 0.031, 0.042, 0.031}};
  return choice;
}

// A user's mesh with one tiny element in it.
Injected inject_files(int count) {
  Injected counts;
  for (int k = 0; k < count; ++k) {
    fdem::MeshChoice choice = plate();
    choice.seed = static_cast<std::uint64_t>(k) + 1;
    TriangleMesh mesh = fdem::make_mesh(choice)->mesh;
    studies::squeeze(mesh, allowed * std::pow(10.0, -0.02 - 0.3 * k));
    const fdem::MeshResult read = fdem::read_msh(fdem::write_msh(mesh), choice);
    (read ? counts.made : counts.refused) += 1;
    counts.wrong += read.has_value() || read.error().find("mm high") == std::string::npos;
  }
  return counts;
}

// Round the gate: a plate let go from a small strain, with the step of a sound mesh. True where energy grew out of nothing and was seen.
bool is_seen(const Scene& scene, const TriangleMesh& mesh, double dt) {
  const auto body = make_fdem(scene, mesh);
  if (!body->start(dt)) return true;
  const SampleRow first = body->sample(0, dt);
  for (long long n = 0; n < 400; ++n) {
    if (!body->step(n, dt)) return true;
    const SampleRow row = body->sample(n + 1, dt);
    if (!(row.kinetic_energy + row.elastic_energy <= 1.05 * (first.kinetic_energy + first.elastic_energy))) return true;
  }
  return false;
}

}  // namespace

std::vector<Row> slivers(Desk& desk) {
  const Injected cracks = inject_cracks(desk, 400), files = inject_files(8);
  std::vector<Row> rows{
      compare("400 pairs of cracks that nearly touch: meshes with a height below the gate, refusals without a reason", "", 0.0,
              cracks.wrong, 0.0, fmt::format("{} repaired and meshed, {} refused", cracks.made, cracks.refused)),
      compare("users' meshes with a tiny element that were taken", "", 0.0, files.wrong, 0.0, fmt::format("{} refused", files.refused))};
  Scene scene = studies::fdem_scene({"shale", "uniaxial", 1}, 2026);
  scene.width = scene.height = 0.06, scene.cracks = plate().cracks;
  for (auto& side : scene.loads) side.clear();
  scene.initial.strain = {0.0, 1e-6, 0.0};
  const TriangleMesh sound = fdem::make_mesh(plate())->mesh;
  const double dt = scene.fdem.dt_fraction * make_fdem(scene, sound)->stable_dt();
  rows.push_back(compare("sound mesh at 0.7 of its bound: energy grows", "", 0.0, is_seen(scene, sound, dt), 0.0));
  for (const double share : {0.1, 0.01}) {
    desk.progress("round the gate", 0.9);
    TriangleMesh mesh = sound;
    studies::squeeze(mesh, share * allowed);
    const double bound = make_fdem(scene, mesh)->stable_dt();
    rows.push_back(compare(fmt::format("an element {} of the gate's height, step of the sound mesh: energy grows and is seen", share), "",
                           1.0, is_seen(scene, mesh, dt), 0.0, fmt::format("its own bound is {:.2g} of that step", bound / dt)));
    rows.push_back(compare(fmt::format("an element {} of the gate's height, 0.95 of its own bound: energy grows", share), "", 0.0,
                           is_seen(scene, mesh, 0.95 * bound), 0.0));
  }
  return rows;
}

}  // namespace fracfarm::verification
