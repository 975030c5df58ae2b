// The work on blocks of 16 triangles or joints, compiled once for each instruction set and number type from the same sources (kernels/) and
// chosen when a run starts; which block when is the business of solver.cpp. Every path gives the same bits: no contraction, and the sums of
// a chunk are 16 partial sums added in a fixed order.
#pragma once

#include <span>
#include <string_view>

#include "solver/law/corotated.hpp"
#include "solver/law/j2.hpp"
#include "solver/law/joint.hpp"

namespace fracfarm::fdem {

inline constexpr int lanes = 16;        // in a block
inline constexpr int row_size = 8;      // x0 z0 x1 z1 x2 z2 x0 z0: edge k of a triangle is one load of four at 2 k
inline constexpr int slot_size = 12;    // forces of a triangle's three joints, four numbers an edge: both ends
inline constexpr int shape_count = 6;   // B11 B12 B21 B22 area inverse mass
inline constexpr int corner_count = 6;  // x0 z0 x1 z1 x2 z2

// Constants of a block of triangles.
template <class Real>
struct TriangleLaw {
  law::Stiffness<Real> stiffness;
  law::J2<Real> j2;
  Real viscosity;  // Pa s, of the rate of strain
  Real per_mass;   // 3 / density, m^3/kg
  bool plastic;
};

// What a block of triangles needs beside its own motion; 0 for most.
enum BlockNeeds : unsigned char { needs_extra = 1, needs_told = 2 };

enum class Curve { munjiza, linear };

// Joints in blocks of one law; a pad has no length and two triangles of its own.
template <class Real>
struct JointPlaces {
  const int *left_row, *right_row;    // [b][l], places in `rows`
  const int *left_slot, *right_slot;  // [b][l], places in `slots`
  const Real* length;                 // [b][l], m; 0: no spring
  const Real* along;                  // [b][2][l], m: from the first node to the second, undeformed
  const int* law_of_block;            // [b]
};

// Raw pointers: what every kernel sees. [b] is a block, [l] a lane in it.
template <class Real>
struct View {
  // Triangles.
  const Real* shape;                 // [b][shape_count][l], 1/m, m^2, m/kg; B is the inverse of the edges' matrix
  const TriangleLaw<Real>* laws;     //
  const int* law_of_block;           // [b]
  Real *u, *v;                       // [b][corner_count][l], m, m/s (half a step behind)
  Real* rows;                        // [triangle][row_size], the same displacements
  Real* slots;                       // [triangle][slot_size], N/m
  Real* plastic;                     // [b][4][l], plastic strain and alpha; nullptr where nothing yields
  const unsigned char* needs;        // [b], BlockNeeds
  const Real* extra;                 // [triangle][row_size], N/m: tractions, weight, contact
  const int* told_of_block;          // [b], index into the arrays below
  const Real *told, *told_velocity;  // [i][corner_count][l]: 1 where the velocity is told, and that velocity of the next half step
  Real* told_force;                  // [i][corner_count][l], N/m: internal force and extra
  // Joints that are springs so far, and those that are followed (with damage, or near it).
  JointPlaces<Real> springs, followed;
  const Real* reach;       // by law, m^2: springs that open further at an end may soften
  unsigned char* softens;  // [b]: 1 where a spring of the block does
  Real *damage, *kept;     // [b][2][l], at the two points; and the curve's z of it
  Real *opening, *force;   // [b][4][l], m, N/m: of the left triangle at both nodes, where it was last followed
  unsigned char* breaks;   // [b]: becomes 1 where a followed joint of the block broke
  unsigned short* grew;    // [b]: bit l becomes 1 where the one in lane l was damaged further
  const law::Joint<Real>* joint_laws;
  Curve curve;
  bool always_flow;    // the radial return in every block
  Real least_kinetic;  // m^2/s^2, of a triangle's v- v+
};

struct Blocks {
  int begin, end;
};

// What the triangles of a chunk add to the ledger of a step.
struct AdvanceSums {
  double viscous;  // W/m: power of viscosity before the kick
  double plastic;  // J/m
};

// The state as it is, without moving it.
struct TriangleSums {
  double stress_xx, stress_zz;  // N: over the area
  double elastic, joints;       // J/m, stored; joints are springs along secants, so that it is half of what their forces do along openings
  double plastic;               // J/m, what this configuration would still add
  double viscous;               // W/m
  double kinetic;               // J/m: 1/2 m v- v+ of the velocities half a step before and after, by triangle no less than `least_kinetic`
  double fastest;               // m^2/s^2, largest square of a velocity
};

template <class Real>
struct Kernels {
  std::string_view isa;
  // Forces at u, v += dt f / m, u += dt v.
  AdvanceSums (*advance)(const View<Real>&, Blocks, Real dt);
  TriangleSums (*measure)(const View<Real>&, Blocks, Real dt);
  // Forces of the springs at u into the slots of both sides; which of them soften and must be followed from now on.
  void (*join)(const View<Real>&, Blocks);
  // The same of followed joints, over what join left there; returns the work that is gone, J/m.
  double (*follow)(const View<Real>&, Blocks);
};

// Paths that this processor runs, best first; the last is the baseline, which every processor runs.
template <class Real>
std::span<const Kernels<Real>* const> runnable_kernels();

// The best runnable path, or the one that the environment variable FRACFARM_ISA (baseline, v3, v4) names where it runs here.
template <class Real>
const Kernels<Real>& chosen_kernels();

}  // namespace fracfarm::fdem
