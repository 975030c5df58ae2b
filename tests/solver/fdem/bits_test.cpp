// The same bits whatever instruction set, threads, rules that are exact, or a stop and a resume in between.
#include <cstring>

#include "solver/archive.hpp"
#include "tests/solver/fdem/specimens.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

constexpr int steps = 1300;

template <class Real>
struct Outcome {
  std::vector<float> damage;
  std::string bytes;
  SampleRow row;
  int broken;
};

template <class Real>
double step_of() {
  return sizeof(Real) == 8 ? 2e-8 : 4e-8;
}

template <class Real>
Outcome<Real> outcome_of(fdem::Fdem<Real>& run, long long from = 0) {
  const double dt = step_of<Real>();
  go(run, dt, from, steps);
  ArchiveWriter archive;
  run.save(archive);
  return {run.stored_damage(), archive.bytes(), run.sample(steps, dt), broken(run)};
}

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <class Real>
void check_same(const Outcome<Real>& a, const Outcome<Real>& b) {
  CHECK(a.damage == b.damage);
  CHECK(a.bytes == b.bytes);
  CHECK(same(a.row.stress_zz, b.row.stress_zz));
  CHECK(same(a.row.kinetic_energy, b.row.kinetic_energy));
  CHECK(same(a.row.viscous_energy, b.row.viscous_energy));
  CHECK(same(a.row.plastic_energy, b.row.plastic_energy));
  CHECK(same(a.row.external_work, b.row.external_work));
  CHECK(same(a.row.reaction[3], b.row.reaction[3]));
}

template <class Real>
constexpr FdemTier tier_of = sizeof(Real) == 8 ? FdemTier::reference : FdemTier::fast;

template <class Real>
void check_paths(const char* material) {
  const auto baseline = outcome_of(*plate<Real>(material, tier_of<Real>, {}, 1, *fdem::runnable_kernels<Real>().back()));
  CHECK(baseline.broken > 2);
  for (const fdem::Kernels<Real>* kernels : fdem::runnable_kernels<Real>()) {
    INFO(material << " " << kernels->isa << (sizeof(Real) == 8 ? " double" : " float"));
    check_same(baseline, outcome_of(*plate<Real>(material, tier_of<Real>, {}, 1, *kernels)));
  }
}

}  // namespace

TEST_CASE("every instruction set tears a plate with the same bits") {
  check_paths<double>("shale");
  check_paths<float>("shale");
}

TEST_CASE("every instruction set gives the same bits where metal flows") {
  const auto after = [](const fdem::Kernels<float>& kernels) {
    Scene scene = plate_scene("tungsten", FdemTier::fast);
    scene.layers[0].material.plasticity->yield = 5e7;
    fdem::Fdem<float> run(fdem::body_of(scene, plate_mesh()), scene.fdem, {}, 1, kernels);
    return outcome_of(run);
  };
  const auto baseline = after(*fdem::runnable_kernels<float>().back());
  CHECK(baseline.row.plastic_energy > 1.0);
  for (const fdem::Kernels<float>* kernels : fdem::runnable_kernels<float>()) check_same(baseline, after(*kernels));
}

TEST_CASE("threads do not change a bit") {
  const auto one = outcome_of(*plate<float>("shale", FdemTier::fast));
  check_same(one, outcome_of(*plate<float>("shale", FdemTier::fast, {}, 3)));
}

// Eight chunks of triangles that fly apart: nearly half of the joints soften within a hundred steps.
std::unique_ptr<fdem::Fdem<float>> burst(int threads) {
  constexpr int cells = 64;
  constexpr double h = 0.004;
  fdem::Body body;
  body.mesh = rectangle(cells, cells, h);
  body.materials = {*find_material("pbx")};
  for (const auto& triangle : body.mesh.triangles)
    for (const int node : triangle) {
      const auto [x, z] = body.mesh.nodes[static_cast<std::size_t>(node)];
      body.velocity.push_back({10.0 * x, 200.0 * z * (1.0 + std::sin(40.0 * x))});
    }
  return std::make_unique<fdem::Fdem<float>>(std::move(body), settings_of(FdemTier::fast, h), Rules{}, threads);
}

TEST_CASE("threads do not change a bit of a body of many chunks, nor does joining them while they are in the cache") {
  constexpr int burst_steps = 120;
  const double dt = 4e-8;
  const auto one = burst(1), three = burst(3);
  REQUIRE(one->plan().triangle_blocks() > 7 * fdem::triangle_chunk);
  go(*one, dt, 0, burst_steps), go(*three, dt, 0, burst_steps);
  CHECK(one->state().settled > 1000);
  ArchiveWriter a, b;
  one->save(a), three->save(b);
  CHECK(a.bytes() == b.bytes());
  CHECK(same(one->sample(burst_steps, dt).elastic_energy, three->sample(burst_steps, dt).elastic_energy));
}

TEST_CASE("a resumed run has the bits of one that never stopped") {
  const double dt = step_of<float>();
  const auto never_stopped = plate<float>("shale", FdemTier::fast);
  const auto whole = outcome_of(*never_stopped);
  CHECK(never_stopped->state().settled > 0);
  bool joints_out_of_order = false;
  for (const long long stop : {1LL, 500LL, 1200LL}) {
    const auto first = plate<float>("shale", FdemTier::fast), second = plate<float>("shale", FdemTier::fast);
    go(*first, dt, 0, stop);
    (void)first->sample(stop, dt);
    joints_out_of_order |= first->state().followed.size() > static_cast<std::size_t>(first->state().settled);
    ArchiveWriter archive;
    first->save(archive);
    ArchiveReader reader(archive.bytes());
    REQUIRE(second->load(reader, stop, dt));
    CHECK(reader.finished());
    check_same(whole, outcome_of(*second, stop));
  }
  CHECK(joints_out_of_order);
}

TEST_CASE("the edges that may have changed are all that did") {
  const auto run = plate<float>("shale", FdemTier::fast);
  const double dt = step_of<float>();
  std::vector<float> known = run->stored_damage();
  std::size_t told = 0;
  for (long long n = 0; n < steps; n += 10) {
    go(*run, dt, n, n + 10);
    std::vector<EdgeDamage> changes;
    run->take_damage_changes(changes);
    for (const EdgeDamage& now : changes) known[now.edge] = now.damage;
    told += changes.size();
    REQUIRE(known == run->stored_damage());
  }
  CHECK(told < known.size() * (steps / 10));
}

TEST_CASE("a checkpoint that was cut or is of another mesh is refused") {
  const auto run = plate<float>("shale", FdemTier::fast);
  go(*run, step_of<float>(), 0, 5);
  ArchiveWriter archive;
  run->save(archive);
  for (const std::size_t length : {std::size_t{0}, std::size_t{100}, archive.bytes().size() / 2}) {
    ArchiveReader cut(std::string_view(archive.bytes()).substr(0, length));
    CHECK(!plate<float>("shale", FdemTier::fast)->load(cut, 5, step_of<float>()));
  }
}

TEST_CASE("damage only where joints are stretched, and flow only where metal yields, are exact") {
  Rules everywhere;
  everywhere.damage_where_stretched = everywhere.flow_where_it_yields = false;
  const auto lazy = plate<float>("shale", FdemTier::fast), busy = plate<float>("shale", FdemTier::fast, everywhere);
  const auto one = outcome_of(*lazy), other = outcome_of(*busy);
  CHECK(one.damage == other.damage);
  CHECK(same(one.row.stress_zz, other.row.stress_zz));
  CHECK(same(one.row.kinetic_energy, other.row.kinetic_energy));
  CHECK(lazy->break_time().size() == busy->break_time().size());
  const auto flows = outcome_of(*plate<double>("tungsten", FdemTier::reference)),
             tests = outcome_of(*plate<double>("tungsten", FdemTier::reference, everywhere));
  CHECK(same(flows.row.stress_zz, tests.row.stress_zz));
  CHECK(same(flows.row.plastic_energy, tests.row.plastic_energy));
}
