// FD-1: a joint between two triangles that are moved as told, and its law alone, against closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "common/base/random.hpp"
#include "solver/fdem/materials.hpp"
#include "solver/fdem/mesh/assemble.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/fdem/cases.hpp"

namespace fracfarm::verification {
namespace {

constexpr double side = 0.003;  // m
const Cohesion strength{0.6, 5e6, 20e6, 30.0, 120.0};
const Material stone = cohesive(2500.0, 20e9, 0.25, strength);

// A path in the plane of opening: `angle` from the normal (0: mode I, 90 degrees: mode II).
struct Way {
  const char* name;
  double angle;  // degrees
};
constexpr Way ways[]{{"mode I", 0.0}, {"mode II", 90.0}, {"mixed, 30 degrees", 30.0}, {"mixed, 75 degrees", 75.0}};

double cosine(const Way& way) { return way.angle == 90.0 ? 0.0 : std::cos(way.angle * std::numbers::pi / 180.0); }
double sine(const Way& way) { return std::sin(way.angle * std::numbers::pi / 180.0); }

struct Ends {
  double onset, rupture;  // m, along the path
  double work;            // J/m^2: of the whole path
};

// On a straight path from 0 the traction along it is p z(D) times the opening at onset: what is done is the triangle up to there and the
// curve's area times the rest.
Ends ends_of(const law::Joint<double>& law, const Way& way, double area) {
  const double c = cosine(way), s = sine(way);
  Ends ends{};
  ends.onset = 1.0 / std::hypot(c * law.per_onset_n, s * law.per_onset_t);
  ends.rupture = 1.0 / std::hypot(c * law.per_rupture_n, s * law.per_rupture_t);
  ends.work = law.penalty * ends.onset * (0.5 * ends.onset + area * (ends.rupture - ends.onset));
  return ends;
}

// A led half in whole steps, so that the kinks of the traction (onset, both turns) lie between two steps.
struct Course {
  double step;          // m
  int out, back, last;  // steps: out until `out`, back until `back`, then on until `last`
};

constexpr double dt = 1e-4;  // s: slow, there is next to no kinetic energy

Course course_of(const Ends& ends) {
  const double step = ends.onset / std::ceil(1e4 * ends.onset / ends.rupture);
  const int out = static_cast<int>(0.5 * ends.rupture / step), back = static_cast<int>(0.4 * ends.rupture / step);
  return {step, out, out + back, out + 2 * back + static_cast<int>(0.52 * ends.rupture / step)};
}

// A square cut along its diagonal, one half held and the other led away, most of the path back, and on until it is broken.
fdem::Body two_triangles(const Way& way, const Course& course) {
  fdem::Soup soup;
  soup.nodes = {{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  fdem::Body body;
  body.mesh = fdem::assemble(soup).value();
  body.materials = {stone};
  const double x = (cosine(way) + sine(way)) / std::numbers::sqrt2, z = (sine(way) - cosine(way)) / std::numbers::sqrt2;
  const auto [left, right] = body.mesh.edge_triangles[0];
  const auto& first = body.mesh.nodes[static_cast<std::size_t>(body.mesh.edge_nodes[0][0])];
  const double turned = first[0] < 0.5 * side ? 1.0 : -1.0;
  for (const Axis axis : {Axis::x, Axis::z}) {
    body.told.push_back(held({3 * left, 3 * left + 1, 3 * left + 2}, axis));
    const double speed = turned * (axis == Axis::x ? x : z) * course.step / dt;
    const auto velocity = [=](double t) {
      const double n = t / dt;
      return n < 0.0 ? 0.0 : n > course.out && n < course.back ? -speed : speed;
    };
    body.told.push_back({{3 * right, 3 * right + 1, 3 * right + 2}, axis, velocity, std::nullopt});
  }
  return body;
}

Row through_the_solver(const Way& way, Softening softening, double& smallest_gain) {
  FdemSettings settings = reference_settings(side);
  settings.softening = softening, settings.penalty = 1.0;  // a tenth of the path to its onset: the steps resolve it
  const law::Joint<double> law = fdem::joint_law(stone, stone, settings);
  const double area = softening == Softening::munjiza ? law::area_under<law::Munjiza>() : 0.5;
  const Ends ends = ends_of(law, way, area);
  const Course course = course_of(ends);
  Run<double> run(two_triangles(way, course), settings);
  run.use_dt(dt);
  if (!run.start()) return compare("start", "J/m^2", 1.0, 0.0, 0.0);
  double gone = 0.0;
  for (int n = 0; n < course.last; ++n) {
    run.step();
    const double now = run.fdem().state().ledger.fracture;
    smallest_gain = std::min(smallest_gain, (now - gone) / (ends.work * side)), gone = now;
  }
  const SampleRow end = run.sample();
  const double length = side * std::numbers::sqrt2;
  return compare(
      fmt::format("{}, {} curve: dissipated on the way out, back and on", way.name, softening == Softening::munjiza ? "Munjiza" : "linear"),
      "J/m^2", ends.work, end.fracture_energy / length, 1e-8, fmt::format("work done on it {:.10g}", end.external_work / length));
}

// Work of a straight path by Simpson's rule, from the law alone.
template <class Curve>
Row from_the_law(const Way& way) {
  FdemSettings settings = reference_settings(side);
  settings.softening = std::is_same_v<Curve, law::Munjiza> ? Softening::munjiza : Softening::linear;
  const law::Joint<double> law = fdem::joint_law(stone, stone, settings);
  const double c = cosine(way), s = sine(way);
  const Ends ends = ends_of(law, way, law::area_under<Curve>());
  const auto traction = [&](double opening) {
    const auto answer = law::answer<Curve>(law, law::Opening<double>{opening * c, opening * s}, 0.0);
    return answer.normal * c + answer.shear * s;
  };
  constexpr int parts = 2000;
  double sum = 0.0;
  for (const auto& [from, to] : {std::pair{0.0, ends.onset}, {ends.onset, ends.rupture}})
    for (int i = 0; i < parts; ++i) {
      const double h = (to - from) / parts, x = from + i * h;
      sum += h / 6.0 * (traction(x) + 4.0 * traction(x + 0.5 * h) + traction(x + h));
    }
  return compare(fmt::format("{}: area under the law", way.name), "J/m^2",
                 way.angle == 0.0    ? strength.GI
                 : way.angle == 90.0 ? strength.GII
                                     : ends.work,
                 sum, 1e-8);
}

// Farthest that D is from 1 at d = 1, and from less than 1 just before it, over all directions.
Row envelope(const law::Joint<double>& law) {
  double worst = 0.0;
  bool early = false;
  for (int degree = 0; degree <= 90; ++degree) {
    const Way way{"", static_cast<double>(degree)};
    const double rupture = ends_of(law, way, 0.5).rupture, c = cosine(way), s = sine(way);
    const auto damage = [&](double share) {
      return law::answer<law::Munjiza>(law, law::Opening<double>{share * rupture * c, share * rupture * s}, 0.0).damage;
    };
    worst = std::max(worst, std::abs(damage(1.0) - 1.0));
    early = early || damage(1.0 - 1e-9) >= 1.0;
  }
  return compare("D at d = 1, every degree from mode I to mode II: farthest from 1", "1", 0.0, early ? INFINITY : worst, 1e-12);
}

// Straight back to closed from any damage and mix of modes, and out again: what of the stored energy the way back does not return, or
// returns twice.
Row straight_back(const law::Joint<double>& law) {
  double worst = 0.0;
  RandomStream random(2026, 1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const law::Opening<double> far{random.uniform(0.0, 1.0) / law.per_rupture_n, random.uniform(-1.0, 1.0) / law.per_rupture_t};
    const auto loaded = law::answer<law::Munjiza>(law, far, random.uniform(0.0, 1.0));
    const double stored = 0.5 * (loaded.normal * far.n + loaded.shear * far.t);
    double work = 0.0;
    constexpr int steps = 100;
    for (int i = 0; i < steps; ++i) {
      const double from = 1.0 - static_cast<double>(i) / steps, to = 1.0 - (i + 1.0) / steps, mid = 0.5 * (from + to);
      const auto answer = law::answer<law::Munjiza>(law, law::Opening<double>{mid * far.n, mid * far.t}, loaded.damage);
      work += (from - to) * (answer.normal * far.n + answer.shear * far.t);
    }
    worst = std::max(worst, std::abs(work - stored) / strength.GI);
  }
  return compare("1000 random openings, straight back: returned less stored, over G_I", "1", 0.0, worst, 1e-12);
}

// What a closed loop returns at a damage D that does not grow: from closed straight out in tension, along the openings that just keep D
// round to pure sliding, and straight back.
double loop_gain(const law::Joint<double>& law, double D) {
  const auto opening = [&](double angle) {
    const Way way{"", angle};
    const Ends ends = ends_of(law, way, 0.5);
    const double r = ends.onset / ends.rupture, size = (D * (1.0 - r) + r) * ends.rupture;
    return law::Opening<double>{size * cosine(way), size * sine(way)};
  };
  const auto traction = [&](const law::Opening<double>& at) { return law::answer<law::Munjiza>(law, at, D); };
  const law::Opening<double> n = opening(0.0), t = opening(90.0);
  double gain = 0.5 * traction(t).shear * t.t - 0.5 * traction(n).normal * n.n;
  constexpr int parts = 900;
  for (int i = 0; i < parts; ++i) {
    const law::Opening<double> from = opening(90.0 * i / parts), to = opening(90.0 * (i + 1) / parts);
    const auto before = traction(from), after = traction(to);
    gain -= 0.5 * ((before.normal + after.normal) * (to.n - from.n) + (before.shear + after.shear) * (to.t - from.t));
  }
  return gain;
}

// The law has no potential, so that such a loop is not 0; a figure, since it is the published law that we have.
Row turning(const law::Joint<double>& law) {
  double most = 0.0;
  for (int percent = 1; percent < 100; ++percent) most = std::max(most, std::abs(loop_gain(law, 0.01 * percent)));
  return report("closed loop tension, round to sliding, back at one D: most it returns or takes, over G_I", "1", most / strength.GI,
                "the published law has no potential: its stiffness at a given D depends on the mix of modes");
}

}  // namespace

std::vector<Row> one_joint(Desk&) {
  std::vector<Row> rows;
  for (const Way& way : ways) rows.push_back(from_the_law<law::Munjiza>(way));
  const law::Joint<double> law = fdem::joint_law(stone, stone, reference_settings(side));
  rows.push_back(envelope(law));
  rows.push_back(straight_back(law));
  rows.push_back(turning(law));
  double smallest_gain = 0.0;
  for (const Softening softening : {Softening::munjiza, Softening::linear})
    for (const Way& way : ways) rows.push_back(through_the_solver(way, softening, smallest_gain));
  rows.push_back(compare("the same runs: largest fall of what is dissipated, over the whole", "1", 0.0, -smallest_gain, 1e-12));
  return rows;
}

}  // namespace fracfarm::verification
