// PF-30: the plate with a notch under a sudden tension on both sides, whose crack forks (Borden and others, 2012).
#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// Where the final field is in two, m, and when the tip was there, s.
struct Place {
  double x = NAN, onset = NAN;
};

struct Fork {
  std::vector<double> time, tip;  // s, m: rightmost damage above 0.9
  Place open, broken;             // by damage above 0.9 (a crack of this project) and above 0.98
  int arms = 0;                   // at the right end of the crack
  double fastest = 0.0;           // m/s, over 4 mm of advance
  std::vector<Damage> panels;
};

double rightmost(Specimen& s) {
  for (int i = s.columns() - 1; i > 0; --i)
    for (int j = 0; j < s.rows(); ++j)
      if (s.psi_at(i, j) > 0.9) return i * s.hx();
  return 0.0;
}

// Runs of damage above the threshold in a column of nodes.
int arms_at(Specimen& s, int column, double threshold) {
  int arms = 0;
  for (int j = 1; j < s.rows(); ++j) arms += s.psi_at(column, j) > threshold && s.psi_at(column, j - 1) <= threshold;
  return arms;
}

// The fork is the leftmost column from which on, for 2 mm, every column is in two.
Place find_fork(Specimen& s, const Fork& fork, double threshold) {
  const int tip = static_cast<int>(fork.tip.back() / s.hx()), first = static_cast<int>(0.052 / s.hx()),
            run = static_cast<int>(2e-3 / s.hx());
  Place place;
  int in_two = 0;
  for (int i = first; i <= tip && std::isnan(place.x); ++i) {
    in_two = arms_at(s, i, threshold) == 2 ? in_two + 1 : 0;
    if (in_two == run) place.x = (i - run + 1) * s.hx();
  }
  for (std::size_t k = 0; k < fork.tip.size() && std::isnan(place.onset); ++k)
    if (fork.tip[k] >= place.x) place.onset = fork.time[k];
  return place;
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
  fork.open = find_fork(specimen, fork, 0.9), fork.broken = find_fork(specimen, fork, 0.98);
  fork.arms = arms_at(specimen, static_cast<int>((fork.tip.back() - 2e-3) / specimen.hx()), 0.9);
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
    Split split;
  };
  constexpr std::array runs{Run{"h = l/2", 400, 0.9, Split::seed}, Run{"h = l/2, dt/2", 400, 0.45, Split::seed},
                            Run{"h = l/2, spectral split", 400, 0.9, Split::spectral}, Run{"h = l/4", 800, 0.9, Split::seed}};
  std::vector<Row> rows;
  std::vector<Damage> panels;
  Chart tips{"Tip of the crack", {"time", "s"}, {"x", "m"}, {}};
  Fork fork;
  double done = 0.0;
  for (const Run& run : runs) {
    const double share = std::pow(run.cells / 800.0, 3.0) * 0.9 / run.cfl / 1.5;
    desk.part(done, share);
    done += share;
    Scene scene = plate(run.cells, run.cfl);
    scene.phase_field.split = run.split;
    fork = run_plate(desk, scene, run.name);
    tips.lines.push_back({run.name, palette[tips.lines.size()], fork.time, fork.tip});
    for (const Damage& panel : fork.panels) panels.push_back(panel);
    if (&run == &runs.back()) break;
    rows.push_back(report(fmt::format("{}: time at which the tip forks", run.name), "s", fork.open.onset,
                          fmt::format("at x = {:.2f} mm, fastest tip {:.0f} m/s, {} arms", 1e3 * fork.open.x, fork.fastest, fork.arms)));
  }
  rows.push_back(between("h = l/4: time at which the tip forks", "s", {35e-6, 37e-6}, fork.open.onset, 0.0,
                         fmt::format("where damage above 0.9 is in two; above 0.98 it is so from {:.1f} µs on", 1e6 * fork.broken.onset)));
  rows.push_back(between("h = l/4: place of the fork", "m", {0.066, 0.068}, fork.open.x, 0.0,
                         fmt::format("damage above 0.98 is in two from {:.2f} mm on", 1e3 * fork.broken.x)));
  rows.push_back(between("h = l/4: fastest tip, over 4 mm", "m/s", {0.0, 0.6 * rayleigh}, fork.fastest, 0.0));
  rows.push_back(compare("h = l/4: arms at the end", "1", 2.0, fork.arms, 0.0));
  desk.add({"branching", "PF-30: damage at the end.", damage_page("Branching plate", panels, 480, 2)});
  desk.add({"branching_tip", "PF-30: place of the foremost damage above 0.9.", chart_page({tips})});
  return rows;
}

}  // namespace fracfarm::verification
