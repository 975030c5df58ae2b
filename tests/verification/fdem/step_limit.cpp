// FD-4: the edge of the time step, known before a run.
#include <fmt/format.h>

#include <algorithm>

#include "common/base/random.hpp"
#include "solver/fdem/mesh/make_mesh.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

struct Plate {
  const char* name;
  const char* material;
  FdemTier tier;
  double viscosity;
  std::vector<Segment> cracks = {};
  bool half_asleep = false;
};

fdem::Body body_of(const Plate& plate) {
  fdem::MeshChoice choice;
  choice.width = choice.height = 0.036, choice.cracks = plate.cracks;
  fdem::Body body;
  body.mesh = fdem::make_mesh(choice).value().mesh;
  body.materials = {unbreakable_material(plate.material)};
  if (plate.half_asleep) {
    body.asleep.assign(body.mesh.edge_nodes.size(), 0);
    for (const int e : edges_where(body.mesh, [](double x, double) { return x < 0.018; }))
      if (body.mesh.edge_kind[static_cast<std::size_t>(e)] == EdgeKind::joint) body.asleep[static_cast<std::size_t>(e)] = 1;
  }
  RandomStream random(2026, 1, 4);
  for (std::size_t i = 0; i < 3 * body.mesh.triangles.size(); ++i)
    body.velocity.push_back({random.uniform(-1e-6, 1e-6), random.uniform(-1e-6, 1e-6)});
  return body;
}

struct Growth {
  double edge;   // s
  double ratio;  // fastest corner after 2000 steps over that at the start
};

Growth growth(const Plate& plate, double share) {
  FdemSettings settings;
  settings.tier = plate.tier, settings.viscosity = plate.viscosity, settings.precision = Precision::double_;
  if (plate.tier == FdemTier::fast) settings.penalty = 8.0;  // joints that never break would have the reference tier's
  Run<double> run(body_of(plate), settings, share);
  const auto fastest = [&] {
    double most = 0.0;
    for (fdem::Corner corner = 0; corner < run.corners(); ++corner)
      for (const int axis : {0, 1}) {
        const double v = std::abs(run.v(corner, axis));
        most = std::isfinite(v) ? std::max(most, v) : INFINITY;
      }
    return most;
  };
  if (!run.start()) return {NAN, NAN};
  const double start = fastest();
  double most = 0.0;
  for (int part = 0; part < 20 && !(most > 1e9 * start); ++part) run.steps(100), most = fastest();
  return {run.fdem().stable_dt(), most / start};
}

}  // namespace

std::vector<Row> step_limit(Desk&) {
  const std::vector<Segment> near_cracks{{0.006, 0.018, 0.030, 0.018}, {0.018, 0.0205, 0.018, 0.033}};
  std::vector<Row> rows;
  for (const Plate& plate : {Plate{"shale, reference tier", "shale", FdemTier::reference, 0.1},
                             Plate{"tungsten, reference tier", "tungsten", FdemTier::reference, 0.1},
                             Plate{"pbx, reference tier, no viscosity", "pbx", FdemTier::reference, 0.0},
                             Plate{"shale, fast tier", "shale", FdemTier::fast, 0.1},
                             Plate{"pbx, fast tier, three times the viscosity", "pbx", FdemTier::fast, 0.3},
                             Plate{"shale, fast tier, cracks that nearly meet", "shale", FdemTier::fast, 0.1, near_cracks},
                             Plate{"shale, fast tier, half of the joints asleep", "shale", FdemTier::fast, 0.1, {}, true}}) {
    const Growth below = growth(plate, 0.95), above = growth(plate, 1.05);
    rows.push_back(between(fmt::format("{}: growth at 0.95 of the edge", plate.name), "1", {0.0, 10.0}, below.ratio, 0.0,
                           fmt::format("edge {:.4g} ns, printed before the run", 1e9 * below.edge)));
    rows.push_back(between(fmt::format("{}: growth at 1.05", plate.name), "1", {1e6, INFINITY}, above.ratio, 0.0));
  }
  return rows;
}

}  // namespace fracfarm::verification
