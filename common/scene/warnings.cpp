// What SCENES.md allows but a user should know of: sentences, never refusals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/parse_parts.hpp"

namespace fracfarm {
namespace {

constexpr double most_width_cells = 40.0;
constexpr std::size_t max_compared_cracks = 2000;  // pairs grow with the square

double length_scale(const Scene& scene, const Material& material) {
  switch (scene.phase_field.length_scale.kind) {
    case LengthScale::Kind::half:
      return material.characteristic_width / 2;
    case LengthScale::Kind::full:
      return material.characteristic_width;
    case LengthScale::Kind::metres:
      return scene.phase_field.length_scale.metres;
  }
  return 0.0;
}

double cross(double ax, double az, double bx, double bz) { return ax * bz - az * bx; }

bool crossing(const Segment& a, const Segment& b) {
  const double ax = a.x1 - a.x0, az = a.z1 - a.z0, bx = b.x1 - b.x0, bz = b.z1 - b.z0;
  const double b0 = cross(ax, az, b.x0 - a.x0, b.z0 - a.z0), b1 = cross(ax, az, b.x1 - a.x0, b.z1 - a.z0);
  const double a0 = cross(bx, bz, a.x0 - b.x0, a.z0 - b.z0), a1 = cross(bx, bz, a.x1 - b.x0, a.z1 - b.z0);
  return b0 * b1 < 0 && a0 * a1 < 0;
}

double distance(double x, double z, const Segment& s) {
  const double sx = s.x1 - s.x0, sz = s.z1 - s.z0;
  const double along = std::clamp(((x - s.x0) * sx + (z - s.z0) * sz) / (sx * sx + sz * sz), 0.0, 1.0);
  return std::hypot(x - s.x0 - along * sx, z - s.z0 - along * sz);
}

double distance(const Segment& a, const Segment& b) {
  if (crossing(a, b)) return 0.0;
  return std::min({distance(a.x0, a.z0, b), distance(a.x1, a.z1, b), distance(b.x0, b.z0, a), distance(b.x1, b.z1, a)});
}

// Pairs that neither meet nor keep `gap` apart.
std::size_t close_pairs(const std::vector<Segment>& cracks, double gap) {
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < cracks.size(); ++i)
    for (std::size_t j = i + 1; j < cracks.size(); ++j) {
      const double apart = distance(cracks[i], cracks[j]);
      if (apart > 0 && apart < gap) ++pairs;
    }
  return pairs;
}

// What free corners leave of the explicit scheme's edge where C13 > C55, at most 0.01 below the largest eigenvalue of plates with all sides
// free, which gives 0.985, 0.962, 0.920, 0.889, 0.866 at Poisson's ratio 0.36, 0.40, 0.45, 0.48, 0.4999. Grids of one or two cells have
// less.
double corner_edge(const Elasticity& c) {
  const double element = (std::max(c.C11, c.C33) + c.C55) / (std::max(c.C11, c.C33) + std::max(c.C13, c.C55));
  return std::sqrt(element * (2.0 - element));
}

void warn_materials(const Scene& scene, double h, std::vector<std::string>& out) {
  std::vector<const Material*> told;
  for (const Layer& layer : scene.layers) {
    const Material& material = layer.material;
    if (std::any_of(told.begin(), told.end(), [&](const Material* other) { return *other == material; })) continue;
    told.push_back(&material);
    const double w0 = length_scale(scene, material);
    if (w0 < h)
      out.push_back(fmt::format(
          "{}: w_0 = {} is {:.2f} of a cell: the damage zone is under-resolved (strength within 5 %, through-crack time within 20 %)",
          material.name, engineering(w0, "m"), w0 / h));
    if (w0 > most_width_cells * h)
      out.push_back(fmt::format("{}: w_0 = {} is {:.0f} cells: past about {} the sweeps of the damage equation may not converge",
                                material.name, engineering(w0, "m"), w0 / h, most_width_cells));
    if (material.poisson.value_or(0.0) > 0.45)
      out.push_back(
          fmt::format("{}: Poisson's ratio {} is near 1/2: the elements may lock, and free corners lower the edge of the step to {:.2f}",
                      material.name, shortest(*material.poisson), corner_edge(material.elasticity)));
  }
}

bool loaded(const Scene& scene) {
  const auto moves = [](const SideLoad& part) {
    return part.normal_velocity.value_or(0.0) != 0.0 || part.tangential_velocity != 0.0 || part.traction;
  };
  const auto zero = [](double value) { return value == 0.0; };
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [&](const auto& side) { return std::any_of(side.begin(), side.end(), moves); }) ||
         !std::all_of(scene.initial.strain.begin(), scene.initial.strain.end(), zero) ||
         !std::all_of(scene.initial.velocity_gradient.begin(), scene.initial.velocity_gradient.end(), zero);
}

void warn_cracks(const Scene& scene, std::vector<std::string>& out) {
  double widest = 0.0;
  for (const Layer& layer : scene.layers) widest = std::max(widest, 4 * length_scale(scene, layer.material));
  if (scene.cracks.size() > max_compared_cracks) return;
  if (const std::size_t pairs = close_pairs(scene.cracks, widest); pairs > 0)
    out.push_back(fmt::format("{} pair{} of cracks closer than 4 w_0 = {} that do not meet: their damage zones overlap", pairs,
                              pairs == 1 ? "" : "s", engineering(widest, "m")));
}

// The design's figures: a single implicit pass strengthened the body by 2 / 6 / 18 % at 0.5 / 2 / 8 h / c_p.
void warn_implicit(const Scene& scene, double step_share, std::vector<std::string>& out) {
  const PhaseFieldSettings& settings = scene.phase_field;
  if (settings.integrator != Integrator::explicit_central && settings.staggered_passes == 1)
    out.push_back("a single staggered pass: damage lags by a step and the body is too strong (2 % at half, 6 % at 2 h / c_p a step)");
  if (settings.integrator != Integrator::newmark) return;
  if (step_share > 5.0)
    out.push_back(fmt::format("the step is {:.1f} h / sqrt((C_max + C55) / rho): waves and cracks are smeared past about 5", step_share));
  if (2.0 * settings.newmark_beta < settings.newmark_gamma)
    out.push_back(fmt::format("newmark_beta {} is below half of newmark_gamma {}: stable only for short steps",
                              shortest(settings.newmark_beta), shortest(settings.newmark_gamma)));
}

// What is known of the options before they are run.
void warn_laws(const Scene& scene, std::vector<std::string>& out) {
  const PhaseFieldSettings& settings = scene.phase_field;
  if (settings.crack_seeding == CrackSeeding::nodes && settings.quadrature == Quadrature::gll && !scene.cracks.empty())
    out.push_back("cracks of one row of nodes do not cut under corner quadrature (a third too strong at 127 cells); slot does, or gauss");
}

void warn_phase_field(const Scene& scene, std::vector<std::string>& out) {
  const double hx = scene.width / scene.phase_field.cells_x, hz = scene.height / scene.phase_field.cells_z;
  warn_materials(scene, std::max(hx, hz), out);
  if (std::abs(hx - hz) > 0.01 * std::min(hx, hz))
    out.push_back(fmt::format("cells are {} by {}, not square", engineering(hx, "m"), engineering(hz, "m")));
  const double fraction = scene.phase_field.dt ? *scene.phase_field.dt / step_edge(scene) : scene.phase_field.cfl;
  warn_implicit(scene, fraction, out);
  warn_laws(scene, out);
  if (fraction > 0.95 && scene.phase_field.integrator == Integrator::explicit_central)
    out.push_back(fmt::format("the step is {:.3f} of the stability edge", fraction));
  warn_cracks(scene, out);
}

// Measured on random patterns: see ACCURACY.md.
void warn_fdem(const Scene& scene, std::vector<std::string>& out) {
  if (!scene.fdem.dt && scene.fdem.dt_fraction > 0.9)
    out.push_back(fmt::format("the step is {} of the mesh's bound: past 1 broken joints shed the energy of a run that diverges",
                              shortest(scene.fdem.dt_fraction)));
  for (const Layer& layer : scene.layers)
    if (layer.material.name == "pbx")
      out.push_back(
          "pbx: rho c v exceeds its tensile strength, so that it breaks at the plates and not at its cracks; pbx5 has ten times the "
          "strength");
}

}  // namespace

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> out;
  if (scene.method == Method::drill) return {"a drill: nothing is simulated"};
  scene.method == Method::fdem ? warn_fdem(scene, out) : warn_phase_field(scene, out);
  if (scene.frame_interval > scene.horizon)
    out.push_back("the frame interval is longer than the horizon: only the first and the failure state are stored");
  if (!loaded(scene)) out.push_back("nothing loads the body: it will be CENSORED at its horizon");
  return out;
}

}  // namespace fracfarm
