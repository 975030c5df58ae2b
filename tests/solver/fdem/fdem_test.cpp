#include "solver/fdem/fdem.hpp"

#include "solver/fdem/stable_step.hpp"
#include "tests/solver/fdem/specimens.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

constexpr double dt_reference = 2e-8;

Body free_square(int cells = 6) {
  Body body;
  body.mesh = rectangle(cells, cells, plate_h);
  body.materials = {*find_material("shale")};
  return body;
}

// By corner of the mesh.
std::vector<std::array<double, 2>> at_corners(const TriangleMesh& mesh, const std::function<std::array<double, 2>(double, double)>& field) {
  std::vector<std::array<double, 2>> values;
  for (const auto& triangle : mesh.triangles)
    for (const int node : triangle)
      values.push_back(field(mesh.nodes[static_cast<std::size_t>(node)][0], mesh.nodes[static_cast<std::size_t>(node)][1]));
  return values;
}

struct Momentum {
  double x = 0.0, z = 0.0, turn = 0.0, size = 0.0;
};

Momentum momentum_of(const fdem::Fdem<double>& run) {
  Momentum sum;
  const fdem::Plan& plan = run.plan();
  for (const int slot : plan.slot_of)
    for (int k = 0; k < 3; ++k) {
      const int corner = 3 * slot + k;
      const double m = fdem::corner_mass(plan, corner);
      const double vx = run.state().v[fdem::at_corner(corner, 0)], vz = run.state().v[fdem::at_corner(corner, 1)];
      const double x = plan.corner_rows[fdem::in_row(corner, 0)] + run.state().u[fdem::at_corner(corner, 0)];
      const double z = plan.corner_rows[fdem::in_row(corner, 1)] + run.state().u[fdem::at_corner(corner, 1)];
      sum.x += m * vx, sum.z += m * vz, sum.turn += m * (x * vz - z * vx), sum.size += m * (std::abs(vx) + std::abs(vz));
    }
  return sum;
}

}  // namespace

TEST_CASE("a body that is turned anywhere has no stress and no energy") {
  for (const double angle : {0.1, 1.5, 3.0, -2.0}) {
    Body body = free_square();
    const double c1 = -2.0 * std::pow(std::sin(0.5 * angle), 2), s = std::sin(angle);
    body.displacement = at_corners(body.mesh, [&](double x, double z) {
      return std::array<double, 2>{c1 * x - s * z + 0.3, s * x + c1 * z - 7.0};
    });
    fdem::Fdem<double> run(std::move(body), settings_of(FdemTier::reference, plate_h), {}, 1);
    REQUIRE(run.start(dt_reference));
    const SampleRow row = run.sample(0, dt_reference);
    CHECK(std::abs(row.stress_xx) + std::abs(row.stress_zz) < 1e-12 * 3e10);
    CHECK(row.elastic_energy < 1e-12);
  }
}

TEST_CASE("a spinning, ringing body keeps its momentum and its energy") {
  Body body = free_square();
  body.velocity = at_corners(body.mesh, [](double x, double z) {
    return std::array<double, 2>{3.0 - 400.0 * z + 20.0 * x, 400.0 * x - 1.0};
  });
  FdemSettings settings = settings_of(FdemTier::reference, plate_h);
  fdem::Fdem<double> run(std::move(body), settings, {}, 1);
  const double dt = 0.5 * run.stable_dt();
  REQUIRE(run.start(dt));
  REQUIRE(run.step(0, dt));
  const Momentum before = momentum_of(run);
  go(run, dt, 1, 2000);
  const Momentum after = momentum_of(run);
  CHECK(std::abs(after.x - before.x) < 1e-10 * before.size);
  CHECK(std::abs(after.z - before.z) < 1e-10 * before.size);
  CHECK(std::abs(after.turn - before.turn) < 1e-5 * std::abs(before.turn));
  const SampleRow row = run.sample(2000, dt);
  CHECK(std::abs(row.energy_residual) < 1e-5 * row.kinetic_energy);
  CHECK(broken(run) == 0);
}

TEST_CASE("renumbered nodes and triangles give the same run") {
  const auto outcome = [](bool turned) {
    Scene scene = plate_scene("shale", FdemTier::reference);
    TriangleMesh mesh = plate_mesh();
    if (turned) {
      const int last = static_cast<int>(mesh.nodes.size()) - 1;
      std::reverse(mesh.nodes.begin(), mesh.nodes.end());
      std::reverse(mesh.triangles.begin(), mesh.triangles.end());
      for (auto& t : mesh.triangles) t = {last - t[1], last - t[2], last - t[0]};
      mesh.edge_nodes.clear(), mesh.edge_triangles.clear(), mesh.edge_kind.clear();
      const double middle = plate_cells / 2 * plate_h;
      find_edges(mesh, [=](double x, double z) { return x < 0.4 * middle && std::abs(z - middle) < 0.3 * plate_h; });
    }
    const auto run = make_fdem(scene, mesh);
    go(*run, dt_reference, 0, 800);
    return run->sample(800, dt_reference);
  };
  const SampleRow one = outcome(false), other = outcome(true);
  CHECK(one.stress_zz > 1e6);
  CHECK(other.stress_zz == Approx(one.stress_zz).epsilon(1e-9));
  CHECK(other.elastic_energy == Approx(one.elastic_energy).epsilon(1e-9));
}

TEST_CASE("two triangles that are pulled apart give up the toughness of their edge, and the ledger closes") {
  for (const bool slides : {false, true}) {
    Body body;
    body.mesh.nodes = {{0.0, 0.0}, {plate_h, 0.0}, {0.5 * plate_h, plate_h}, {0.5 * plate_h, -plate_h}};
    body.mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    find_edges(body.mesh);
    body.materials = {*find_material("shale")};
    const Axis moved = slides ? Axis::x : Axis::z, held = slides ? Axis::z : Axis::x;
    const auto still = [](double) { return 0.0; };
    body.told = {{{0, 1, 2}, moved, [](double t) { return 0.5 * ramp_share(t, 2e-5); }, {}},
                 {{3, 4, 5}, moved, still, {}},
                 {{0, 1, 2, 3, 4, 5}, held, still, {}}};
    fdem::Fdem<double> run(std::move(body), settings_of(FdemTier::reference, plate_h), {}, 1);
    go(run, dt_reference, 0, 4000);
    const SampleRow row = run.sample(4000, dt_reference);
    CHECK(broken(run) == 1);
    CHECK(run.stored_damage()[0] == 1.0F);
    CHECK(run.break_mode()[0] == static_cast<unsigned char>(slides ? BreakMode::shear : BreakMode::tension));
    CHECK(row.fracture_energy == Approx((slides ? 400.0 : 100.0) * plate_h).epsilon(2e-5));
    CHECK(row.external_work == Approx(row.fracture_energy + row.kinetic_energy).epsilon(1e-6));
  }
}

TEST_CASE("plates tear a plate with a crack from its tip on, and the ledger closes in every tier") {
  for (const char* material : {"shale", "pbx5"}) {
    INFO(material);
    const auto reference = plate<double>(material, FdemTier::reference);
    const auto fast = plate<float>(material, FdemTier::fast);
    const auto peak = [](MeshSimulation& run, double dt, double limit) {
      REQUIRE(run.start(dt));
      double highest = 0.0;
      const long long steps = std::llround(8e-5 / dt);
      for (long long n = 0; n < steps; ++n) {
        REQUIRE(run.step(n, dt));
        if (n % 20 != 0) continue;
        const SampleRow row = run.sample(n + 1, dt);
        highest = std::max(highest, row.stress_zz);
        if (row.external_work > 1.0) CHECK(std::abs(row.energy_residual) < limit * row.external_work);
        CHECK(row.kinetic_energy + row.elastic_energy <= 1.05 * row.external_work + 1e-6);
      }
      CHECK(broken(run) > plate_cells / 2);
      return highest;
    };
    const double slow_peak = peak(*reference, dt_reference, 1e-3), fast_peak = peak(*fast, 0.7 * fast->stable_dt(), 4e-3);
    CHECK(fast_peak == Approx(slow_peak).epsilon(0.06));
  }
}

TEST_CASE("oscillations do not grow below the printed edge of the step, and do above it") {
  for (const FdemTier tier : {FdemTier::reference, FdemTier::fast})
    for (const double viscosity : {0.0, 0.1, 0.5}) {
      INFO(viscosity);
      const auto energy = [&](double share) {
        Body body = free_square(8);
        body.velocity = at_corners(body.mesh, [](double x, double z) {
          return std::array<double, 2>{1e-7 * std::sin(1e5 * x + z), 1e-7 * std::cos(7e4 * z)};
        });
        FdemSettings settings = settings_of(tier, plate_h);
        settings.viscosity = viscosity;
        fdem::Fdem<double> run(std::move(body), settings, {}, 1);
        const double dt = share * run.stable_dt();
        go(run, dt, 0, 1500);
        const SampleRow row = run.sample(1500, dt);
        return row.kinetic_energy + row.elastic_energy;
      };
      const double calm = energy(0.5);
      CHECK(energy(0.95) < 2.0 * calm + 1e-18);
      CHECK(!(energy(1.05) < 1e3 * calm));
    }
}

TEST_CASE("tied triangles never part, and move as they would with common nodes") {
  Body body = free_square();
  body.asleep.assign(body.mesh.edge_nodes.size(), 1);
  body.velocity = at_corners(body.mesh, [](double x, double) { return std::array<double, 2>{2000.0 * x, 0.0}; });
  FdemSettings settings = settings_of(FdemTier::reference, plate_h);
  settings.viscosity = 0.0;
  fdem::Fdem<double> run(std::move(body), settings, {}, 1);
  const double dt = 0.9 * run.stable_dt();
  CHECK(run.stable_dt() > 5e-8);
  go(run, dt, 0, 300);
  for (const auto& group : run.plan().ties)
    for (const int corner : group) CHECK(run.state().u[fdem::at_corner(corner, 0)] == run.state().u[fdem::at_corner(group.front(), 0)]);
  CHECK(broken(run) == 0);
  const SampleRow row = run.sample(300, dt);
  CHECK(std::abs(row.energy_residual) < 1e-3 * row.kinetic_energy);
}

TEST_CASE("weight and a force bring their work") {
  Body body = free_square();
  body.gravity = {0.0, -10.0};
  body.pulls = {{{0, 1, 2}, {{5.0, 0.0}, {5.0, 0.0}, {5.0, 0.0}}, [](double) { return 1.0; }}};
  const double mass = body.materials[0].density * 36 * plate_h * plate_h;
  FdemSettings settings = settings_of(FdemTier::reference, plate_h);
  settings.viscosity = 0.0;
  fdem::Fdem<double> run(std::move(body), settings, {}, 1);
  go(run, dt_reference, 0, 500);
  const SampleRow row = run.sample(500, dt_reference);
  const Momentum momentum = momentum_of(run);
  CHECK(momentum.z == Approx(-10.0 * mass * (499.5 * dt_reference)).epsilon(1e-9));
  CHECK(momentum.x == Approx(15.0 * (499.5 * dt_reference)).epsilon(1e-9));
  CHECK(std::abs(row.energy_residual) < 1e-4 * row.external_work);
}
