// Which path runs a scene: the row kernels where they can, the assembled matrices where the scene asks for more.
#include "solver/phasefield/assembled/assembled.hpp"
#include "solver/phasefield/phase_field.hpp"

namespace fracfarm {
namespace {

bool rows_can(const Scene& scene) {
  const PhaseFieldSettings& settings = scene.phase_field;
  return settings.integrator == Integrator::explicit_central && settings.quadrature == Quadrature::gll &&
         settings.plasticity != PlasticityModel::j2;
}

}  // namespace

std::unique_ptr<GridSimulation> make_phase_field(const Scene& scene, const Rules& rules) {
  if (!rows_can(scene)) return std::make_unique<phasefield::assembled::Assembled>(scene);
  using namespace phasefield;
  if (scene.phase_field.precision == Precision::float_) return std::make_unique<PhaseField<float>>(scene, chosen_kernels<float>(), rules);
  return std::make_unique<PhaseField<double>>(scene, chosen_kernels<double>(), rules);
}

}  // namespace fracfarm
