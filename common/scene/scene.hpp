// What is to be simulated: plain typed structs in SI units, x to the right, z up, origin at the lower left corner.
// A scene says everything that can change a result and nothing else: no wall clock, no thread count, no folders.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/material/material.hpp"

namespace fracfarm {

enum class Method { phase_field, fdem, drill };
enum class CrackSet { orthogonal, oblique };

// A crack, from end to end (m).
struct Segment {
  double x0 = 0.0;
  double z0 = 0.0;
  double x1 = 0.0;
  double z1 = 0.0;
  bool operator==(const Segment&) const = default;
};

// Horizontal layers from the bottom up; `below` is the layer's top (m), the last one reaches the domain's top.
struct Layer {
  double below = 0.0;
  Material material;
  bool operator==(const Layer&) const = default;
};

enum class Side { left, right, bottom, top };
inline constexpr std::array<Side, 4> all_sides{Side::left, Side::right, Side::bottom, Side::top};

enum class Tangential { free, fixed, velocity };

// What happens on a part of a side. Normal velocity is positive outward (extension); ramps are linear from 0 over `ramp` seconds.
struct SideLoad {
  double from = 0.0;  // m along the side, from its lower or left end
  double to = 0.0;
  std::optional<double> normal_velocity;  // m/s; 0 holds the side
  Tangential tangential = Tangential::free;
  double tangential_velocity = 0.0;               // m/s along +x or +z
  double ramp = 0.0;                              // s
  std::optional<std::array<double, 2>> traction;  // Pa, (x, z)
  bool operator==(const SideLoad&) const = default;
};

struct Initial {
  std::array<double, 3> strain{};             // xx, zz, xz (tensor shear)
  std::array<double, 4> velocity_gradient{};  // dvx/dx dvx/dz dvz/dx dvz/dz, about the domain's centre
  bool operator==(const Initial&) const = default;
};

enum class Stop { failure, drop10, horizon };  // drop10: fdem only, 1.8 times the time of the stress drop
enum class StepControl { fixed, adaptive };    // adaptive: a run that ends SOLVER_NUMERIC begins again with half the step
enum class CrackSeeding { slot, nodes, history };
enum class PlasticityModel { none, secant, j2 };
enum class SurfaceModel { at2, at1 };
enum class Plane { strain, stress };
enum class Split { seed, none, spectral, volumetric_deviatoric, star_convex };
enum class Quadrature { gll, gauss };
enum class Integrator { explicit_central, newmark, quasi_static };
enum class Precision { double_, float_ };

struct LengthScale {
  enum class Kind { half, full, metres } kind = Kind::half;
  double metres = 0.0;
  bool operator==(const LengthScale&) const = default;
};

struct PhaseFieldSettings {
  int cells_x = 127;
  int cells_z = 127;
  LengthScale length_scale;
  double residual_stiffness = 1e-6;  // eta
  CrackSeeding crack_seeding = CrackSeeding::slot;
  SurfaceModel surface = SurfaceModel::at2;
  Plane plane = Plane::strain;
  Split split = Split::seed;
  double star_convexity = 5.0;  // gamma*, where the split is star_convex
  PlasticityModel plasticity = PlasticityModel::secant;
  double plastic_drive = 0.0;  // share of the plastic work in the damage drive, where plasticity is j2
  Quadrature quadrature = Quadrature::gll;
  Precision precision = Precision::double_;
  Integrator integrator = Integrator::explicit_central;
  double cfl = 0.9;          // of h / sqrt((C_max + C55) / rho)
  std::optional<double> dt;  // s, instead of cfl; a quasi-static run has no other step
  StepControl step_control = StepControl::fixed;
  double newmark_beta = 0.25, newmark_gamma = 0.5;
  // Newmark and quasi-static: displacement and damage in turns, until the largest change of psi in a pass is below the tolerance.
  double staggered_tolerance = 1e-4;
  int staggered_passes = 100;  // at most; 1 is the single pass
  bool operator==(const PhaseFieldSettings&) const = default;
};

// reference: the paper's letter, p = 100 E / h in double. fast: softer joints between triangles that make up for it, in float. screening:
// fast on a mesh twice as coarse.
enum class FdemTier { reference, fast, screening };
enum class Softening { munjiza, linear };

// What is absent follows the tier.
struct FdemSettings {
  double element_size = 0.003;  // m; 0.006 in the screening tier where it is not given
  FdemTier tier = FdemTier::fast;
  Softening softening = Softening::munjiza;
  std::uint64_t mesh_seed = 1;
  std::string mesh_file;    // a Gmsh .msh file in place of the mesher; empty: none
  std::string mesh_sha256;  // of the file's bytes; a run with another file is refused
  std::optional<Precision> precision;
  std::optional<double> penalty;  // p h / E (reference) or p h / C11 (fast, screening); the tier's own
  double viscosity = 0.1;         // of 2 h sqrt(E rho)
  double contact_penalty = 1.0;   // of E
  double dt_fraction = 0.7;       // of the mesh's bound; 0.35 in the reference tier where it is not given
  std::optional<double> dt;       // s, instead of dt_fraction
  bool operator==(const FdemSettings&) const = default;
};

FdemSettings defaults_of(FdemTier tier);

// What a rehearsal job does instead of a simulation; see FARM.md.
enum class DrillAct { sleep, crash, hang, leak, truncated, bit_flipped, wrong_job, nan, ignore_term };
struct DrillSettings {
  DrillAct act = DrillAct::sleep;
  double seconds = 0.0;  // of work before the act
  int attempts = 0;      // that act; later ones end well. 0: all of them
  bool operator==(const DrillSettings&) const = default;
};

// Where a scene of a campaign came from; identification only, the cracks say what is solved.
struct Sample {
  CrackSet set = CrackSet::orthogonal;
  std::uint64_t seed = 0;  // campaign seed
  std::uint64_t id = 0;    // from 1
  std::string load;        // uniaxial, biaxial
  bool operator==(const Sample&) const = default;
};

struct Scene {
  Method method = Method::phase_field;
  double width = 0.25;        // m
  double height = 0.25;       // m
  std::vector<Layer> layers;  // at least one
  std::vector<Segment> cracks;
  std::array<std::vector<SideLoad>, 4> loads;  // by Side; empty: free
  Initial initial;
  double horizon = 0.0;         // s
  double frame_interval = 0.0;  // s
  Stop stop = Stop::failure;
  PhaseFieldSettings phase_field;
  FdemSettings fdem;
  DrillSettings drill;
  std::optional<Sample> sample;

  const std::vector<SideLoad>& on(Side side) const { return loads[static_cast<std::size_t>(side)]; }
  bool operator==(const Scene&) const = default;
};

}  // namespace fracfarm
