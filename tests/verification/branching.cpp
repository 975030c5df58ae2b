// PF-30: the plate with a notch under a sudden tension on both sides, whose crack forks (Borden and others, 2012).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"
#include "tests/verification/specimen.hpp"

namespace fracfarm::verification {
namespace {

constexpr double young = 32e9, poisson = 0.2, density = 2450.0, Gc = 3.0, width = 0.5e-3, rayleigh = 2125.0;  // c_R, m/s

// Cells across for the 100 mm; one more up than square cells would have, so that the notch lies in the middle of a row of elements.
Scene plate(int cells_x, double cfl) {
  Scene scene = plain_scene(material_of({density, young, poisson, Gc}), cells_x, cells_x * 2 / 5 + 1, 1.0);
  scene.width = 0.1, scene.height = 0.04;
  scene.layers[0].below = scene.height;
  scene.phase_field.residual_stiffness = 1e-6;
  scene.phase_field.length_scale = {LengthScale::Kind::metres, width};
  scene.phase_field.cfl = cfl;
  scene.cracks = {{0.0, 0.02, 0.05, 0.02}};
  for (const Side side : {Side::bottom, Side::top}) {
    SideLoad pull;
    pull.to = scene.width;
    pull.traction = {0.0, side == Side::top ? 1e6 : -1e6};
    set_load(scene, side, pull);
  }
  scene.horizon = 80e-6;
  return scene;
}

struct Fork {
  std::vector<double> time, tip;  // s, m: rightmost damage above 0.9
  double x = NAN, onset = NAN;    // of the fork: where the final field is in two, and when the tip was there
  int arms = 0;                   // at the right end of the crack
  double fastest = 0.0;           // m/s, over 4 mm of advance
  double residual = 0.0;
  std::vector<Damage> panels;
};

double rightmost(Specimen& s) {
  for (int i = s.columns() - 1; i > 0; --i)
    for (int j = 0; j < s.rows(); ++j)
      if (s.psi_at(i, j) > 0.9) return i * s.hx();
  return 0.0;
}

// Runs of damage above 0.9 in a column of nodes.
int arms_at(Specimen& s, int column) {
  int arms = 0;
  for (int j = 1; j < s.rows(); ++j) arms += s.psi_at(column, j) > 0.9 && s.psi_at(column, j - 1) <= 0.9;
  return arms;
}

// The fork is the leftmost column from which on, for 2 mm, every column is in two.
void find_fork(Specimen& s, Fork& fork) {
  const int tip = static_cast<int>(rightmost(s) / s.hx()), first = static_cast<int>(0.052 / s.hx()), run = static_cast<int>(2e-3 / s.hx());
  int in_two = 0;
  for (int i = first; i <= tip && std::isnan(fork.x); ++i) {
    in_two = arms_at(s, i) == 2 ? in_two + 1 : 0;
    if (in_two == run) fork.x = (i - run + 1) * s.hx();
  }
  fork.arms = arms_at(s, std::max(first, tip - run));
  for (std::size_t k = 0; k < fork.tip.size() && std::isnan(fork.onset); ++k)
    if (fork.tip[k] >= fork.x) fork.onset = fork.time[k];
}

double fastest(const Fork& fork) {
  double most = 0.0;
  std::size_t back = 0;
  for (std::size_t k = 0; k < fork.tip.size(); ++k) {
    while (fork.tip[k] - fork.tip[back + 1] > 4e-3) ++back;
    if (fork.tip[back] > 0.052 && fork.tip[k] - fork.tip[back] > 4e-3)
      most = std::max(most, (fork.tip[k] - fork.tip[back]) / (fork.time[k] - fork.time[back]));
  }
  return most;
}

Fork run_plate(Desk& desk, const Scene& scene, std::string_view name) {
  Fork fork;
  Specimen specimen(scene);
  const auto look = [&](Specimen& s) {
    fork.time.push_back(s.time()), fork.tip.push_back(rightmost(s));
    return fork.tip.back() < 0.099;
  };
  const int every = std::max(1, static_cast<int>(0.25e-6 / specimen.dt()));
  if (!specimen.run(desk, name, every, look)) return fork;
  find_fork(specimen, fork);
  fork.fastest = fastest(fork);
  fork.panels.push_back(specimen.damage(fmt::format("{}, {:.1f} µs", name, 1e6 * specimen.time())));
  return fork;
}

}  // namespace

std::vector<Row> branching(Desk& desk) {
  struct Run {
    const char* name;
    int cells;
    double cfl;
  };
  std::vector<Row> rows;
  std::vector<Damage> panels;
  Chart tips{"Tip of the crack", {"time", "s"}, {"x", "m"}, {}};
  double done = 0.0;
  for (const Run& run : {Run{"h = l/2", 400, 0.9}, Run{"h = l/2, dt/2", 400, 0.45}, Run{"h = l/3", 600, 0.9}, Run{"h = l/4", 800, 0.9}}) {
    const double share = std::pow(run.cells / 800.0, 3.0) * 0.9 / run.cfl / 1.8;
    desk.part(done, share);
    done += share;
    const Fork fork = run_plate(desk, plate(run.cells, run.cfl), run.name);
    const std::string at = std::string(run.name) + ": ";
    rows.push_back(between(at + "time at which the tip forks", "s", {35e-6, 37e-6}, fork.onset, 0.0));
    rows.push_back(between(at + "place of the fork", "m", {0.066, 0.068}, fork.x, 0.0));
    rows.push_back(between(at + "fastest tip, over 4 mm", "m/s", {0.0, 0.6 * rayleigh}, fork.fastest, 0.0));
    rows.push_back(compare(at + "arms at the end", "1", 2.0, fork.arms, 0.0));
    tips.lines.push_back({run.name, palette[tips.lines.size()], fork.time, fork.tip});
    for (const Damage& panel : fork.panels) panels.push_back(panel);
  }
  desk.add({"branching", "PF-30: damage when the crack reaches the right side.", damage_page("Branching plate", panels, 480)});
  desk.add({"branching_tip", "PF-30: place of the foremost damage above 0.9.", chart_page({tips})});
  return rows;
}

}  // namespace fracfarm::verification
