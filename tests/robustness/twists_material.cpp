#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

json isotropic(Draw& draw) {
  return {{"density", draw.log_uniform(1e3, 2e4)},
          {"young", draw.log_uniform(1e9, 4e11)},
          {"poisson", draw.uniform(0.0, 0.4)},
          {"Gc", draw.log_uniform(10.0, 1e5)},
          {"characteristic_width", 0.004}};
}

void custom(json& scene, Draw& draw) { scene["material"] = isotropic(draw); }

// Everything that the grammar's ranges allow.
void absurd_constants(json& scene, Draw& draw) {
  scene["material"] = {{"density", draw.log_uniform(1e-12, 1e6)},
                       {"young", draw.log_uniform(1e-9, 1e15)},
                       {"poisson", draw.uniform(0.0, 0.4999)},
                       {"Gc", draw.log_uniform(1e-12, 1e12)},
                       {"characteristic_width", draw.log_uniform(1e-9, 1e3)}};
}

void denormal_constants(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  static constexpr const char* keys[]{"density", "young", "Gc", "characteristic_width"};
  static constexpr double values[]{4.9e-324, 1e-310, 2.2250738585072014e-308, 1e-300, 1e-200, 1e-100, 1e-30};
  scene["material"][draw.pick(keys)] = draw.pick(values);
}

void incompressible(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  static constexpr double ratios[]{0.45, 0.49, 0.499, 0.4999, 0.49991, 0.5};
  scene["material"]["poisson"] = draw.pick(ratios);
}

void orthotropic(json& scene, Draw& draw) {
  const double C11 = draw.log_uniform(1e6, 1e12), C33 = draw.log_uniform(1e6, 1e12);
  static constexpr double shares[]{0.0, 0.5, 0.999, 0.999999999, 1.0, 1.1};
  scene["material"] = {{"density", draw.log_uniform(500.0, 2e4)},
                       {"C11", C11},
                       {"C33", C33},
                       {"C13", draw.sign() * draw.pick(shares) * std::sqrt(C11 * C33)},
                       {"C55", draw.log_uniform(1e3, 1e13)},
                       {"Gc", draw.log_uniform(1.0, 1e5)},
                       {"characteristic_width", 0.004}};
}

void brittle(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  scene["material"]["Gc"] = draw.log_uniform(1e-12, 1e-3);
}
void unbreakable(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  scene["material"]["Gc"] = draw.log_uniform(1e8, 1e12);
}
void yielding(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  scene["material"]["yield"] = draw.log_uniform(1e-3, 1e10);
  scene["material"]["hardening"] = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-3, 1e13);
}

void narrow_width(json& scene, Draw& draw) {
  scene["phase_field"]["length_scale"] = number_at(scene, "/domain/width") * draw.log_uniform(1e-7, 1e-2);
}
void broad_width(json& scene, Draw& draw) {
  scene["phase_field"]["length_scale"] = number_at(scene, "/domain/width") * draw.log_uniform(0.1, 1e5);
}

void mixed_keys(json& scene, Draw& draw) {
  scene["material"] = isotropic(draw);
  static constexpr const char* extra[]{"C11", "C13", "yield", "friction", "GI", "youngs", "Poisson", "hardening", "E"};
  scene["material"][draw.pick(extra)] = draw.log_uniform(1.0, 1e10);
}

constexpr Twist table[]{
    {"custom", custom},
    {"absurd_constants", absurd_constants},
    {"denormal_constants", denormal_constants},
    {"incompressible", incompressible},
    {"orthotropic", orthotropic},
    {"brittle", brittle},
    {"unbreakable", unbreakable},
    {"yielding", yielding},
    {"narrow_width", narrow_width},
    {"broad_width", broad_width},
    {"mixed_keys", mixed_keys},
};

}  // namespace

std::span<const Twist> material_twists() { return table; }

}  // namespace fracfarm::robustness
