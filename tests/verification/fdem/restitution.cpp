// FD-10: what impacts give back. Rigid bodies by contact alone, then elastic blocks in the solver.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/random.hpp"
#include "tests/solver/fdem/contact/random_pair.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/contact_cases.hpp"
#include "tests/verification/fdem/two_bodies.hpp"

namespace fracfarm::verification {
namespace {

constexpr double h = 0.003, density = 2500.0, young = 20e9;
const Material stone = cohesive(density, young, 0.2, {0.0, never, never, never, never});

struct Worst {
  int met = 0;
  double off = 0.0, gain = 0.0, mean = 0.0, lost = 0.0, ledger = 0.0;
};

// Random impacts of rigid triangles and blocks of 3 mm.
Worst rigid_impacts(int count, double friction, double dt) {
  using namespace fdem::testing;
  Worst worst;
  for (int id = 0; id < count; ++id) {
    RandomStream random(2026, static_cast<std::uint64_t>(id), 10);
    const Impact one = impact(random_pair(random), friction, dt);
    if (!one.met) continue;
    ++worst.met;
    worst.off = std::max(worst.off, std::abs(std::sqrt(one.after / one.before) - 1.0));
    worst.gain = std::max(worst.gain, one.after / one.before - 1.0);
    worst.mean += one.after / one.before - 1.0;
    worst.ledger = std::max(worst.ledger, std::abs((one.after + one.friction) / one.before - 1.0));
    worst.lost = std::max(worst.lost, 1.0 - one.after / one.before);
  }
  worst.mean /= worst.met;
  return worst;
}

struct Bounce {
  double e = 0.0, residual = 0.0;  // speed of parting over that of meeting; of the ledger, over the energy put in
};

// Two square blocks of 4 x 4 squares meet face to face, or a corner meets a face.
Bounce elastic_bounce(double penalty, double turn) {
  TriangleMesh left = crossed_mesh(parts_of(0.0, 4 * h, 4), parts_of(0.0, 4 * h, 4)), right = left;
  const double half = 2 * h, c = std::cos(turn), s = std::sin(turn), reach = half * (std::abs(c) + std::abs(s));
  for (auto& [x, z] : right.nodes) {
    const double dx = x - half, dz = z - half;
    x = 2 * half + reach + 1e-6 + c * dx - s * dz, z = half + s * dx + c * dz;
  }
  fdem::Body body = two_bodies(left, right, stone);
  const int first = static_cast<int>(left.triangles.size()), all = static_cast<int>(body.mesh.triangles.size());
  constexpr double v = 5.0;
  body.velocity.assign(3 * body.mesh.triangles.size(), {v, 0.0});
  for (int corner = 3 * first; corner < 3 * all; ++corner) body.velocity[static_cast<std::size_t>(corner)][0] = -v;
  FdemSettings settings = reference_settings(h);
  settings.contact_penalty = penalty, settings.viscosity = 0.0;
  Run<double> run(std::move(body), settings, 0.2);
  if (!run.start()) return {};
  const double put_in = run.sample().kinetic_energy;
  bool met = false;
  for (int n = 0; n < 200000; ++n) {
    run.step();
    if (n % 20 != 0) continue;
    const double contact = run.sample().contact_energy;
    if (met && contact == 0.0) break;
    met = met || contact > 0.0;
  }
  const double parting = drift_of(run, first, all).velocity[0] - drift_of(run, 0, first).velocity[0];
  return {parting / (2.0 * v), std::abs(run.sample().energy_residual) / put_in};
}

}  // namespace

std::vector<Row> restitution(Desk& desk) {
  std::vector<Row> rows;
  desk.progress("rigid impacts", 0.0);
  const Worst fine = rigid_impacts(1000, 0.0, 2e-8), coarse = rigid_impacts(300, 0.0, 8e-8), rough = rigid_impacts(100, 0.6, 2e-8);
  rows.push_back(compare("rigid, without friction: largest |e - 1|, e by kinetic energy", "1", 0.0, fine.off, 0.005,
                         fmt::format("{} impacts at random turns and offsets, dt 20 ns", fine.met)));
  rows.push_back(compare("rigid: largest gain of kinetic energy", "1", 0.0, fine.gain, 0.005, "the time step's; goes with its square"));
  rows.push_back(
      report("rigid: mean change of kinetic energy at dt 80 ns", "1", coarse.mean, fmt::format("largest gain {:.2g}", coarse.gain)));
  rows.push_back(compare("rigid, friction 0.6: largest open ledger", "1", 0.0, rough.ledger, 0.01,
                         fmt::format("{} impacts, which lost {:.0f} % at most", rough.met, 100.0 * rough.lost)));
  desk.progress("elastic blocks", 0.8);
  const Bounce soft = elastic_bounce(0.005, 0.0), hard = elastic_bounce(1.0, 0.0), corner = elastic_bounce(1.0, 0.6);
  rows.push_back(compare("elastic blocks face to face, contact of 0.005 E (slow against waves): e", "1", 1.0, soft.e, 0.005));
  rows.push_back(compare("elastic blocks face to face, contact of 1 E: open ledger", "1", 0.0, hard.residual, 0.005,
                         fmt::format("e = {:.3f}: the rest rings in the blocks", hard.e)));
  rows.push_back(compare("a corner on a face, contact of 1 E: open ledger", "1", 0.0, corner.residual, 0.005));
  return rows;
}

}  // namespace fracfarm::verification
