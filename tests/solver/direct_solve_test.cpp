// The matrix-free psi solve against a second method: the same equation assembled element by element and factorised by Eigen.
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>

#include <vector>

#include "common/base/random.hpp"
#include "solver/phasefield/kernels.hpp"
#include "solver/phasefield/model.hpp"
#include "solver/phasefield/passes.hpp"
#include "solver/phasefield/state.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::phasefield;

namespace {

// Shale below tungsten on cells that are no squares, with a crack through both: nothing in it is symmetric or equal.
Scene layered_scene() {
  Scene scene = test::square("shale", 24);
  scene.height *= 1.4;
  scene.layers = {{0.4 * scene.height, *find_material("shale")}, {scene.height, *find_material("tungsten")}};
  scene.cracks = {{0.2 * scene.width, 0.3 * scene.height, 0.6 * scene.width, 0.7 * scene.height}};
  return scene;
}

// Corner energies from nothing to far beyond what breaks the material, the same for both methods.
void draw_history(const Model& model, State<double>& state) {
  RandomStream random(2026, 1, 0);
  for (int j = 0; j < model.grid.cells_z(); ++j)
    for (int i = 0; i < model.grid.cells_x(); ++i)
      for (int corner = 0; corner < 4; ++corner)
        set_history(model.grid, state, i, j, corner, random.uniform() < 0.5 ? 0.0 : random.uniform(0.0, 3e5));
}

// G_c (psi / w_0 - w_0 lap psi) + 2 H psi = 2 H, corner quadrature, element by element; held nodes moved to the right side.
std::vector<double> solve_directly(const Scene& scene, const Model& model, const State<double>& state) {
  const Grid& grid = model.grid;
  const double area = 0.25 * grid.hx * grid.hz, across = 0.5 * grid.hz / grid.hx, along = 0.5 * grid.hx / grid.hz;
  const int nodes = grid.columns * grid.rows;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(nodes);
  const auto node = [&](int i, int j) { return j * grid.columns + i; };
  const auto held = [&](int n) { return model.mask[static_cast<std::size_t>(n)] != 0; };
  const auto couple = [&](int a, int b, double stiffness) {
    for (const auto& [row, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (held(row)) continue;
      entries.emplace_back(row, row, stiffness);
      if (held(other))
        right[row] += stiffness;
      else
        entries.emplace_back(row, other, -stiffness);
    }
  };
  for (int j = 0; j < grid.cells_z(); ++j) {
    const Material& material = scene.layers[(j + 0.5) * grid.hz < scene.layers[0].below ? 0 : 1].material;
    const double width = 0.5 * material.characteristic_width;
    for (int i = 0; i < grid.cells_x(); ++i) {
      const int corners[4] = {node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)};
      for (int c = 0; c < 4; ++c) {
        const double H = history_at(grid, state, i, j, c);
        if (held(corners[c])) continue;
        entries.emplace_back(corners[c], corners[c], area * (material.Gc / width + 2.0 * H));
        right[corners[c]] += area * 2.0 * H;
      }
      couple(corners[0], corners[1], material.Gc * width * across);
      couple(corners[2], corners[3], material.Gc * width * across);
      couple(corners[0], corners[2], material.Gc * width * along);
      couple(corners[1], corners[3], material.Gc * width * along);
    }
  }
  for (int n = 0; n < nodes; ++n)
    if (held(n)) entries.emplace_back(n, n, 1.0), right[n] = 1.0;
  Eigen::SparseMatrix<double> matrix(nodes, nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd psi = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  return {psi.begin(), psi.end()};
}

}  // namespace

TEST_CASE("the matrix-free psi solve agrees with a direct factorisation on layers, oblong cells and cracks") {
  const Scene scene = layered_scene();
  Model model = build_model(scene);
  model.damage_tolerance = 1e-14;
  State<double> state = make_state<double>(model);
  Scratch<double> scratch = make_scratch<double>(model);
  draw_history(model, state);
  const Kernels<double>& kernels = chosen_kernels<double>();
  strain(model, state, scratch, kernels);
  REQUIRE(solve_damage(model, state, scratch, kernels));
  const std::vector<double> direct = solve_directly(scene, model, state);
  double worst = 0.0, highest = 0.0;
  for (int j = 0; j < model.grid.rows; ++j)
    for (int i = 0; i < model.grid.columns; ++i) {
      const double psi = direct[static_cast<std::size_t>(j * model.grid.columns + i)];
      worst = std::max(worst, std::abs(psi - state.psi[model.grid.index(i, j)]));
      if (!model.mask[static_cast<std::size_t>(j * model.grid.columns + i)]) highest = std::max(highest, psi);
    }
  CHECK(highest > 0.5);  // something was solved for
  CHECK(worst < 1e-12);
}
