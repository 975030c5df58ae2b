// Constants of triangles and joints from a material and the settings: penalty by tier, compensated stiffness, viscosity, openings at
// rupture. One place for what the tiers mean.
#pragma once

#include "common/scene/scene.hpp"
#include "solver/fdem/kernels.hpp"

namespace fracfarm::fdem {

// E of an isotropic material; C33 - C13^2 / C11 of others (Pa).
double young_of(const Material& material);

// p, Pa/m: 100 E / h in the reference tier; in the others 8 C11 / h, more where the cohesive zone is short beside h, up to that of the
// reference tier; or the factor that the settings give.
double penalty_of(const Material& material, const FdemSettings& settings);

// Of contact, Pa.
double contact_penalty_of(const Material& material, const FdemSettings& settings);

Curve curve_of(const FdemSettings& settings);

// Joints between two materials have the weaker one's numbers, each for itself.
law::Joint<double> joint_law(const Material& left, const Material& right, const FdemSettings& settings);

// `length_per_area`: of joints, 1/m. The fast tiers make up for what theirs are softer than the reference tier's, in stiffness and in what
// viscosity dissipates.
TriangleLaw<double> triangle_law(const Material& material, const FdemSettings& settings, double length_per_area);

}  // namespace fracfarm::fdem
