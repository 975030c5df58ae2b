// A scene run to its end by a case that looks at the damage on the way, and what it reads off the field.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/failure/failure.hpp"
#include "common/scene/scene.hpp"
#include "solver/simulation.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {

// Isotropic, elastic, brittle: density (kg/m^3), Young's modulus (Pa), Poisson's ratio, G_c (J/m^2).
struct Brittle {
  double density, young, poisson, Gc;
};
Material material_of(const Brittle& brittle);

class Specimen {
 public:
  explicit Specimen(const Scene& scene);

  // To the scene's horizon, `every` so many steps `look` at it; ends early where look says false. False where the solver failed.
  bool run(Desk& desk, std::string_view what, int every, const std::function<bool(Specimen&)>& look);

  double time() const { return static_cast<double>(step_) * dt_; }  // s
  double dt() const { return dt_; }
  long long steps() const { return step_; }
  const GridSimulation& simulation() const { return *simulation_; }
  const std::vector<double>& psi();  // now, nodes in rows from the bottom
  double psi_at(int column, int row) { return psi()[static_cast<std::size_t>(row * columns() + column)]; }
  int columns() const { return simulation_->columns(); }
  int rows() const { return simulation_->rows(); }
  double hx() const { return scene_.width / (columns() - 1); }
  double hz() const { return scene_.height / (rows() - 1); }
  bool cracked(CrackDirection direction);  // from side to side above the through-crack threshold
  Damage damage(std::string caption);

 private:
  Scene scene_;
  std::unique_ptr<GridSimulation> simulation_;
  double dt_;
  long long step_ = 0, read_step_ = -1;
  std::vector<double> psi_;
  std::vector<unsigned char> visited_;
};

// Middle of the damage above `threshold` in each column of nodes, m; nothing where there is none.
std::vector<std::optional<double>> crack_path(Specimen& specimen, double threshold);

// Slope of the least-squares line through the path between x = from and x = to, degrees.
double path_angle(const std::vector<std::optional<double>>& path, double h, double from, double to);

}  // namespace fracfarm::verification
