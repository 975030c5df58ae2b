#include "tests/verification/specimen.hpp"

#include <cmath>
#include <numbers>

#include "common/failure/failure.hpp"

namespace fracfarm::verification {

Material material_of(const Brittle& brittle) {
  Material material;
  material.name = "custom";
  material.density = brittle.density;
  material.elasticity = isotropic(brittle.young, brittle.poisson);
  material.young = brittle.young, material.poisson = brittle.poisson;
  material.Gc = brittle.Gc;
  return material;
}

Specimen::Specimen(const Scene& scene)
    : scene_(scene),
      simulation_(make_phase_field(scene_)),
      dt_(scene.phase_field.dt.value_or(scene.phase_field.cfl * simulation_->stable_dt())) {}

bool Specimen::run(Desk& desk, std::string_view what, int every, const std::function<bool(Specimen&)>& look) {
  if (!simulation_->start(dt_)) return false;
  while (time() < scene_.horizon) {
    if (!simulation_->step(step_, dt_)) return false;
    ++step_;
    if (step_ % every != 0) continue;
    desk.progress(what, time() / scene_.horizon);
    if (!look(*this)) break;
  }
  return true;
}

const std::vector<double>& Specimen::psi() {
  if (read_step_ != step_) simulation_->copy_damage(psi_);
  read_step_ = step_;
  return psi_;
}

bool Specimen::cracked(CrackDirection direction) {
  return joins_sides({psi(), columns(), rows()}, through_crack_threshold, direction, visited_);
}

Damage Specimen::damage(std::string caption) {
  return {std::move(caption), std::vector<float>(psi().begin(), psi().end()), columns(), rows(), scene_.width, scene_.height};
}

std::vector<std::optional<double>> crack_path(Specimen& specimen, double threshold) {
  std::vector<std::optional<double>> path(static_cast<std::size_t>(specimen.columns()));
  for (int i = 0; i < specimen.columns(); ++i) {
    double weight = 0.0, moment = 0.0;
    for (int j = 0; j < specimen.rows(); ++j) {
      const double above = std::max(0.0, specimen.psi_at(i, j) - threshold);
      weight += above, moment += above * j * specimen.hz();
    }
    if (weight > 0.0) path[static_cast<std::size_t>(i)] = moment / weight;
  }
  return path;
}

double path_angle(const std::vector<std::optional<double>>& path, double h, double from, double to) {
  double n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double x = static_cast<double>(i) * h;
    if (!path[i] || x < from || x > to) continue;
    n += 1.0, sx += x, sz += *path[i], sxx += x * x, sxz += x * *path[i];
  }
  return std::atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180.0 / std::numbers::pi;
}

}  // namespace fracfarm::verification
