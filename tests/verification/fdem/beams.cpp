// FD-6 and FD-7: cohesive cracks in beams against beam theory. Cracks run along the middle, all else is tied, so that what is measured is
// the joints' toughness and the triangles' bending; loads move so slowly that there is next to no kinetic energy.
#include "tests/verification/fdem/beams.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

using Index = std::size_t;

constexpr double young = 10e9, poisson = 0.3, density = 1000.0;

// Moves the top side's sections: slowly faster for `rise`, then steadily.
std::function<double(double)> ease(double speed, double rise) {
  return [=](double t) {
    const double s = std::clamp(t / rise, 0.0, 1.0);
    return speed * s * s * (3.0 - 2.0 * s);
  };
}

struct Front {
  double broken, damaged;  // m
};

Front front_of(const Run<double>& run, double crack) {
  Front front{crack, crack};
  const TriangleMesh& mesh = run.body().mesh;
  const auto damage = run.fdem().stored_damage();
  for (Index e = 0; e < damage.size(); ++e) {
    if (!(damage[e] > 0.0F)) continue;
    const double x =
        std::max(mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][0])][0], mesh.nodes[static_cast<Index>(mesh.edge_nodes[e][1])][0]);
    front.damaged = std::max(front.damaged, x);
    if (damage[e] >= 1.0F) front.broken = std::max(front.broken, x);
  }
  return front;
}

double mean_of(const std::vector<Reading>& readings, double from, double to, const std::function<double(const Reading&)>& value) {
  double sum = 0.0;
  int count = 0;
  for (const Reading& reading : readings)
    if (reading.crack >= from && reading.crack <= to) sum += value(reading), ++count;
  return sum / count;
}

// J/m^2 a crack takes while it runs, as the ledger has it: slope by least squares.
double dissipated(const std::vector<Reading>& readings, double from, double to) {
  const double x = mean_of(readings, from, to, [](const Reading& r) { return r.crack; });
  const double y = mean_of(readings, from, to, [](const Reading& r) { return r.fracture; });
  const double xy = mean_of(readings, from, to, [=](const Reading& r) { return (r.crack - x) * (r.fracture - y); });
  return xy / mean_of(readings, from, to, [=](const Reading& r) { return (r.crack - x) * (r.crack - x); });
}

std::vector<Row> common_rows(const std::vector<Reading>& readings, const Arms& arms, double toughness, double from, double to,
                             double allowed) {
  double kinetic = 0.0;
  for (const Reading& r : readings)
    if (r.crack >= from) kinetic = std::max(kinetic, r.kinetic / r.work);
  const double zone = mean_of(readings, from, to, [](const Reading& r) { return r.zone; });
  return {compare("energy that the crack takes per advance, off the ledger", "J/m^2", toughness, dissipated(readings, from, to), allowed),
          between("joints in the zone, mean", "1", {5.0, INFINITY}, zone / arms.square(), 0.0),
          between("kinetic energy over the work done while the crack runs, most", "1", {0.0, 0.01}, kinetic, 0.0)};
}

Picture curve(std::string name, std::string caption, const std::vector<Reading>& readings,
              const std::function<double(const Reading&)>& force) {
  Line ours{"FDEM", blue, {}, {}}, theory{"beam theory at the toughness", orange, {}, {}};
  for (const Reading& r : readings) {
    ours.x.push_back(r.deflection), ours.y.push_back(r.force);
    if (r.crack > readings.front().crack) theory.x.push_back(r.deflection), theory.y.push_back(force(r));
  }
  return {std::move(name), std::move(caption), chart_page({{"", {"deflection", "m"}, {"force", "N/m"}, {ours, theory}}})};
}

}  // namespace

fdem::Body beam_body(const Arms& arms) {
  fdem::Body body;
  const int columns = static_cast<int>(std::lround(arms.length / arms.square()));
  body.mesh = crossed_mesh(parts_of(0.0, arms.length, columns), parts_of(0.0, 2.0 * arms.arm, 2 * arms.rows));
  body.materials = {arms.material};
  body.asleep.assign(body.mesh.edge_nodes.size(), 1);
  for (const int e : edges_where(body.mesh, at_z(arms.arm))) {
    const auto [a, b] = body.mesh.edge_nodes[static_cast<Index>(e)];
    const double middle = 0.5 * (body.mesh.nodes[static_cast<Index>(a)][0] + body.mesh.nodes[static_cast<Index>(b)][0]);
    body.asleep[static_cast<Index>(e)] = 0;
    if (middle < arms.crack) body.mesh.edge_kind[static_cast<Index>(e)] = EdgeKind::crack;
  }
  return body;
}

fdem::Told section(const fdem::Body& body, double x, double low, double high, std::function<double(double)> velocity) {
  auto corners =
      corners_where(body.mesh, [=](double node_x, double z) { return std::abs(node_x - x) < 1e-9 && z > low - 1e-9 && z < high + 1e-9; });
  return {std::move(corners), Axis::z, std::move(velocity), std::nullopt};
}

std::vector<Reading> load_beam(Desk& desk, const Arms& arms, fdem::Body body, double until, double limit) {
  FdemSettings settings = reference_settings(arms.square());
  settings.penalty = 10.0;  // of the middle alone: still twenty times as stiff as an arm is across
  body.side_length[static_cast<Index>(Side::top)] = 1.0;
  std::function<double(double)> velocity;
  for (const fdem::Told& told : body.told)
    if (told.side) velocity = told.velocity;
  Run<double> run(std::move(body), settings);
  std::vector<Reading> readings;
  if (!run.start()) return readings;
  double deflection = 0.0;
  while (run.time() < limit) {
    for (int i = 0; i < 200; ++i) deflection += run.dt() * std::abs(velocity(run.time() + 0.5 * run.dt())), run.step();
    const SampleRow row = run.sample();
    const Front front = front_of(run, arms.crack);
    readings.push_back({run.time(), std::abs(row.reaction[static_cast<Index>(Side::top)]), deflection, front.broken,
                        front.damaged - front.broken, row.fracture_energy, row.kinetic_energy, row.external_work});
    desk.progress(fmt::format("crack {:.1f} mm", 1e3 * front.broken), run.time() / limit);
    if (front.broken >= until) break;
  }
  return readings;
}

std::vector<Row> double_cantilever(Desk& desk) {
  constexpr double toughness = 250.0;
  const Arms arms{0.045, 0.003, 4, 0.018, cohesive(density, young, poisson, {0.0, 12e6, never, toughness, never})};
  fdem::Body body = beam_body(arms);
  const auto up = ease(0.5, 4e-4);
  body.told.push_back(section(body, 0.0, arms.arm + 0.1 * arms.square(), 2.0 * arms.arm, up));
  body.told.back().side = Side::top;
  body.told.push_back(section(body, 0.0, 0.0, arms.arm - 0.1 * arms.square(), [up](double t) { return -up(t); }));
  auto wall = corners_where(body.mesh, at_x(arms.length));
  body.told.push_back(held(wall, Axis::x)), body.told.push_back(held(wall, Axis::z));
  const auto readings = load_beam(desk, arms, std::move(body), 0.031, 4e-3);

  const double E = arms.E(), G = arms.G(), h = arms.arm, I = h * h * h / 12.0;
  // Arms lean back into the beam, as if they were longer by chi h (Williams, 1989).
  const double gamma = 1.18 * E / G, part = gamma / (1.0 + gamma), chi = std::sqrt(E / (11.0 * G) * (3.0 - 2.0 * part * part));
  const double a0 = arms.crack + chi * h, compliance = a0 * a0 * a0 / (3.0 * E * I) + 1.2 * arms.crack / (G * h);
  // a from the compliance that there is, and the release rate at it, with the arms' shear.
  const auto length_at = [=](const Reading& r) {
    double a = arms.crack;
    for (int i = 0; i < 50; ++i) a = std::cbrt(3.0 * E * I * std::max(r.deflection / r.force - 1.2 * a / (G * h), 0.0));
    return a;
  };
  const auto release = [=](const Reading& r) {
    const double a = length_at(r);
    return r.force * r.force * (a * a / (E * I) + 1.2 / (G * h));
  };
  const double from = arms.crack + 0.006, to = 0.031;
  double sum = 0.0, count = 0.0;
  for (const Reading& r : readings)
    if (r.crack < arms.crack + 0.5 * arms.square() && r.zone < 1.5 * arms.square() && r.time > 4e-4)
      sum += r.deflection / r.force, count += 1.0;
  std::vector<Row> rows{compare("compliance of an arm while at most one joint opens", "m^2/N", compliance, sum / count, 0.05),
                        compare("release rate from load and deflection of the running crack", "J/m^2", toughness,
                                mean_of(readings, from, to, release), 0.05)};
  for (Row& row : common_rows(readings, arms, toughness, from, to, 0.05)) rows.push_back(std::move(row));
  desk.add(curve("double_cantilever",
                 "FD-6: force against the deflection of an arm, and beam theory for the crack length that the compliance shows.", readings,
                 [&](const Reading& r) { return r.force * std::sqrt(toughness / release(r)); }));
  return rows;
}

std::vector<Row> end_notched(Desk& desk) {
  constexpr double toughness = 300.0;
  const Arms arms{0.072, 0.003, 4, 0.027, cohesive(density, young, poisson, {0.0, never, 20e6, never, toughness})};
  const double L = 0.5 * arms.length, h = arms.arm, E = arms.E(), G = arms.G();
  fdem::Body body = beam_body(arms);
  const auto up = ease(0.3, 1e-3);
  body.told.push_back(section(body, 0.0, 0.0, 2.0 * h, [](double) { return 0.0; }));
  body.told.push_back(section(body, arms.length, 0.0, 2.0 * h, [](double) { return 0.0; }));
  body.told.push_back(section(body, L, 0.0, 2.0 * h, [up](double t) { return -up(t); }));
  body.told.back().side = Side::top;
  body.told.push_back(held(fdem::corners_at(body.mesh, body.mesh.triangles[0][0]), Axis::x));
  const auto readings = load_beam(desk, arms, std::move(body), 0.031, 8e-3);

  const double shear = 3.0 * L / (10.0 * G * h), a0 = arms.crack;
  const double compliance = (3.0 * a0 * a0 * a0 + 2.0 * L * L * L) / (8.0 * E * h * h * h) + shear;
  const auto release = [=](const Reading& r) {
    const double bending = 8.0 * E * h * h * h * (r.deflection / r.force - shear), a = std::cbrt((bending - 2.0 * L * L * L) / 3.0);
    return 9.0 * r.force * r.force * a * a / (16.0 * E * h * h * h);
  };
  const double from = a0 + 0.0005, to = 0.031;  // the zone does not reach the section that is pressed
  double sum = 0.0, count = 0.0;
  for (const Reading& r : readings)
    if (r.crack < a0 + 0.5 * arms.square() && r.zone < 1.5 * arms.square() && r.time > 1e-3) sum += r.deflection / r.force, count += 1.0;
  std::vector<Row> rows{compare("compliance while at most one joint slides", "m^2/N", compliance, sum / count, 0.07),
                        compare("release rate from load and deflection of the running crack", "J/m^2", toughness,
                                mean_of(readings, from, to, release), 0.07)};
  for (Row& row : common_rows(readings, arms, toughness, from, to, 0.07)) rows.push_back(std::move(row));
  desk.add(curve("end_notched", "FD-7: force against deflection, and beam theory for the crack length that the compliance shows.", readings,
                 [&](const Reading& r) { return r.force * std::sqrt(toughness / release(r)); }));
  return rows;
}

}  // namespace fracfarm::verification
