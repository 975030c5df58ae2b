// Model: the plan in a run's number type. State: exactly what a restart needs. Scratch: everything that follows from both.
#pragma once

#include <array>
#include <vector>

#include "solver/fdem/field.hpp"
#include "solver/fdem/plan.hpp"
#include "solver/stage_clock.hpp"

namespace fracfarm::fdem {

// One told degree of freedom.
struct ToldDof {
  std::size_t at;       // in the body's arrays
  std::size_t at_told;  // in the told blocks' arrays
  int motion;           // of Body::told
  double mass;          // kg/m
};

// One pulled corner.
struct PulledCorner {
  int corner;  // 3 slot + k
  int pull;    // of Body::pulls, -1: weight
  double fx, fz;
};

template <class Real>
struct Model {
  Field<Real> shape;
  std::vector<TriangleLaw<Real>> laws;
  std::vector<law::Joint<Real>> joint_laws;
  std::vector<int> told_of_block;
  Field<Real> told;
  std::vector<ToldDof> told_dofs;
  std::vector<PulledCorner> pulled;
  bool plastic = false;
};

// Sums over the body and the run.
struct Ledger {
  double fracture = 0.0;  // J/m since t = 0, as all below
  double viscous = 0.0;   // up to the kick before the last
  double plastic = 0.0;
  double external_work = 0.0;   // of whole steps; the last half is the sample's
  double initial_energy = 0.0;  // before the boundary moved
  double crack_length = 0.0;    // m, of edges that are open: cracks from the start and joints that broke
};

template <class Real>
struct State {
  Field<Real> u, v;                    // [block][corner_count][lane]
  Field<Real> slots;                   // forces of the joints at u, N/m
  Field<Real> plastic;                 // [block][4][lane]
  std::vector<int> followed;           // joints, in the order of their places
  int settled = 0;                     // so many of them were there when joints were last settled (followed.hpp)
  Field<Real> damage, opening, force;  // of followed joints: [block][2][lane], [block][4][lane], [block][4][lane]
  std::vector<double> break_time;      // by edge
  std::vector<unsigned char> break_mode;
  Field<Real> extra;         // rows of tractions, weight and contact at u, N/m
  std::vector<int> exposed;  // sides that contact knows, in the order they came
  unsigned char cracks_exposed = 0;
  Ledger ledger;
};

enum class Stage { boundary, triangles, joints, contact };
inline constexpr std::array<const char*, 4> stage_names{"boundary", "triangles", "joints", "contact"};

// Blocks that are worked on at once, and whose sums are one.
inline constexpr int triangle_chunk = 64, followed_chunk = 16;

// Joints as the kernels go through them, and which one is where, -1: a pad.
template <class Real>
struct JointList {
  std::vector<int> left_row, right_row, left_slot, right_slot, law_of_block;
  Field<Real> length, along;
  std::vector<int> joint_at;
  std::vector<int> ready;        // by chunk of triangles: so many blocks, from the first, are of these triangles and those before alone
  std::vector<int> first_chunk;  // by block: of triangles
  int blocks() const { return static_cast<int>(law_of_block.size()); }
  JointPlaces<Real> places() const {
    return {left_row.data(), right_row.data(), left_slot.data(), right_slot.data(), length.data(), along.data(), law_of_block.data()};
  }
};

template <class Real>
struct Scratch {
  JointList<Real> springs;             // pads where joints were followed since they were last settled
  Field<Real> reach;                   // by law of joints
  std::vector<unsigned char> softens;  // by block of springs
  JointList<Real> followed;            // those settled, and in blocks of their own those that came after
  int settled_blocks = 0;
  std::vector<double> gone;               // J/m, by chunk of the settled blocks, in a step
  Field<Real> kept;                       // of followed joints: as in View
  std::vector<unsigned char> breaks;      // by block of followed joints
  std::vector<unsigned short> grew;       // the same
  std::vector<int> place_of, spring_of;   // place of a joint among the followed ones, -1: a spring; and among the springs
  std::vector<int> free_place;            // by law: next place in its last block, a multiple of `lanes` where that is full
  Field<Real> rows;                       // of u
  Field<Real> told_velocity, told_force;  // of the told blocks
  std::vector<double> told_before;        // by told degree of freedom, m/s, half a step before
  std::vector<unsigned char> needs;       // by triangle block
  std::vector<int> extra_slots;           // whose rows of `extra` may be other than 0
  StageClock<Stage, stage_names.size()> clock;
};

template <class Real>
Model<Real> make_model(const Plan& plan, const Body& body);

// At t = 0: displacements and velocities of the body, no damage but where the plan has pads.
template <class Real>
State<Real> make_state(const Plan& plan, const Model<Real>& model, const Body& body);

template <class Real>
Scratch<Real> make_scratch(const Plan& plan, const Model<Real>& model, const Body& body);

}  // namespace fracfarm::fdem
