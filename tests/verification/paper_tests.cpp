// PF-40 to PF-42: the three tests of the seed paper's technical validation, with its own sizes, grids and rates.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/verification/bench.hpp"
#include "tests/verification/cases.hpp"
#include "tests/verification/specimen.hpp"

namespace fracfarm::verification {
namespace {

Scene paper_scene(const Material& material, double width, double height, int cells_x, int cells_z) {
  Scene scene;
  scene.width = width, scene.height = height;
  scene.layers = {{height, material}};
  scene.phase_field.cells_x = cells_x, scene.phase_field.cells_z = cells_z;
  scene.phase_field.plasticity = PlasticityModel::none;
  return scene;
}

// Both components of the side given; positive outward.
void grip(Scene& scene, Side side, double normal_velocity) {
  SideLoad load = roller(scene.width, Tangential::fixed);
  load.normal_velocity = normal_velocity;
  set_load(scene, side, load);
}

Row failed(std::string what) { return compare(std::move(what), "1", 0.0, INFINITY, 0.0, "the solver stopped with SOLVER_NUMERIC"); }

// The farthest that the path strays from a height, m, between x = from and the right side.
double stray(const std::vector<std::optional<double>>& path, double h, double from, double height) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (static_cast<double>(i) * h >= from) farthest = std::max(farthest, path[i] ? std::abs(*path[i] - height) : INFINITY);
  return farthest;
}

Scene inclined_scene() {
  Material polymer = material_of({1250.0, 280e6, 0.45, 27.0});
  polymer.characteristic_width = 1.5e-3;
  Scene scene = paper_scene(polymer, 0.0702, 0.09, 156, 200);
  const double angle = std::numbers::pi / 3.0;  // from the vertical
  scene.cracks = {{0.0, 0.045 + 0.033 * std::cos(angle), 0.033 * std::sin(angle), 0.045}};
  grip(scene, Side::bottom, 0.0);
  grip(scene, Side::top, 0.01);
  scene.horizon = 0.05;
  return scene;
}

Scene flaws_scene() {
  Material upper = material_of({2182.0, 4.35e9, 0.21, 200.0}), lower = material_of({2355.0, 5.35e9, 0.17, 200.0});
  upper.characteristic_width = lower.characteristic_width = 2e-3;
  Scene scene = paper_scene(upper, 0.07, 0.14, 140, 280);
  scene.layers = {{0.07, lower}, {0.14, upper}};
  const double cos = 0.5, sin = 0.5 * std::sqrt(3.0), near = 0.011, far = 0.026, x = 0.035, z = 0.07;  // m along the line of both flaws
  scene.cracks = {{x - far * cos, z - far * sin, x - near * cos, z - near * sin},
                  {x + near * cos, z + near * sin, x + far * cos, z + far * sin}};
  grip(scene, Side::bottom, -0.1);
  grip(scene, Side::top, -0.1);
  scene.horizon = 0.02;
  return scene;
}

// Nodes of damage above 0.5 farther than 4 w_0 (4 mm) from the line of the flaws: wing cracks.
int aside(Specimen& specimen) {
  int count = 0;
  for (int j = 0; j < specimen.rows(); ++j)
    for (int i = 0; i < specimen.columns(); ++i) {
      const double x = i * specimen.hx() - 0.035, z = j * specimen.hz() - 0.07;
      count += specimen.psi_at(i, j) > 0.5 && std::abs(0.5 * std::sqrt(3.0) * x - 0.5 * z) > 4e-3;
    }
  return count;
}

// Largest damage on the line between the inner ends of the flaws, at its weakest place.
double weakest_link(Specimen& specimen) {
  double weakest = 1.0;
  for (int k = 0; k <= 40; ++k) {
    const double along = -0.011 + 0.022 * k / 40.0;
    const double x = 0.035 + 0.5 * along, z = 0.07 + 0.5 * std::sqrt(3.0) * along;
    const int i = static_cast<int>(std::lround(x / specimen.hx())), j = static_cast<int>(std::lround(z / specimen.hz()));
    double largest = 0.0;
    for (int di = -4; di <= 4; ++di)
      for (int dj = -4; dj <= 4; ++dj) largest = std::max(largest, specimen.psi_at(i + di, j + dj));
    weakest = std::min(weakest, largest);
  }
  return weakest;
}

}  // namespace

std::vector<Row> straight_crack(Desk& desk) {
  Material steel = material_of({4000.0, 210e9, 0.3, 2700.0});
  steel.characteristic_width = 2e-5;
  Scene scene = paper_scene(steel, 1e-3, 1e-3, 200, 200);
  scene.cracks = {{0.0, 0.5e-3, 0.5e-3, 0.5e-3}};
  grip(scene, Side::bottom, 0.0);
  grip(scene, Side::top, 5.0);
  scene.horizon = 2e-5;
  Specimen specimen(scene);
  if (!specimen.run(desk, "straight crack", 10, [](Specimen& s) { return !s.cracked(CrackDirection::left_right); })) return {failed("run")};
  const double h = specimen.hx(), middle = 0.5e-3 + 0.5 * h;  // of the held slot, which lies above the line
  const bool through = specimen.cracked(CrackDirection::left_right);
  desk.add({"straight_crack", "PF-40: damage when the crack reaches the right side.",
            damage_page("Paper test 1", {specimen.damage(fmt::format("{:.2f} µs", 1e6 * specimen.time()))}, 420)});
  return {
      compare("1 where the crack reaches the right side", "1", 1.0, through ? 1.0 : 0.0, 0.0),
      between("farthest from the notch's height, in cells", "h", {0.0, 1.0}, stray(crack_path(specimen, 0.9), h, 0.5e-3, middle) / h, 0.0),
      report("through crack", "s", specimen.time())};
}

std::vector<Row> inclined_crack(Desk& desk) {
  Specimen specimen(inclined_scene());
  if (!specimen.run(desk, "inclined crack", 50, [](Specimen& s) { return !s.cracked(CrackDirection::left_right); })) return {failed("run")};
  const double tip = 0.033 * std::sin(std::numbers::pi / 3.0);
  const auto path = crack_path(specimen, 0.9);
  desk.add({"inclined_crack", "PF-41: damage when the crack reaches the right side.",
            damage_page("Paper test 2", {specimen.damage(fmt::format("{:.2f} ms", 1e3 * specimen.time()))}, 420)});
  return {compare("1 where the crack reaches the right side", "1", 1.0, specimen.cracked(CrackDirection::left_right) ? 1.0 : 0.0, 0.0),
          between("direction over the first 20 mm, against the horizontal", "degrees", {-3.0, 3.0},
                  path_angle(path, specimen.hx(), tip + 0.0015, tip + 0.0215), 0.0),
          between("direction from tip to side", "degrees", {-3.0, 3.0}, path_angle(path, specimen.hx(), tip + 0.0015, 0.069), 0.0),
          report("through crack", "s", specimen.time())};
}

std::vector<Row> two_flaws(Desk& desk) {
  Specimen specimen(flaws_scene());
  std::vector<Damage> panels;
  double linked = 0.0;
  int wings = 0;
  const auto look = [&](Specimen& s) {
    if (linked == 0.0 && weakest_link(s) > 0.9)
      linked = s.time(), wings = aside(s), panels.push_back(s.damage(fmt::format("linked, {:.2f} ms", 1e3 * linked)));
    return !s.cracked(CrackDirection::left_right);
  };
  if (!specimen.run(desk, "two flaws", 50, look)) return {failed("run")};
  panels.push_back(specimen.damage(fmt::format("through, {:.2f} ms", 1e3 * specimen.time())));
  desk.add({"two_flaws", "PF-42: damage when the flaws have linked, and when the crack reaches both sides.",
            damage_page("Paper test 3", panels, 420)});
  return {compare("1 where the flaws link", "1", 1.0, linked > 0.0 ? 1.0 : 0.0, 0.0),
          compare("1 where the crack runs to both sides", "1", 1.0, specimen.cracked(CrackDirection::left_right) ? 1.0 : 0.0, 0.0),
          compare("damaged nodes beside the flaws' line when they link (wing cracks)", "1", 0.0, wings, 0.0,
                  "none with the seed's split, as the paper says of its own"),
          report("linked", "s", linked), report("through crack", "s", specimen.time())};
}

}  // namespace fracfarm::verification
