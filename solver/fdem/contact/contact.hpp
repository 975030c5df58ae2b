// Contact between broken edges: which pairs of sides may touch (cells of linear cost), and the potential contact force with Coulomb
// friction between them. Knows nothing of joints, laws or time loops.
//
// A point P on an exposed side (three Gauss points each) that is a depth d inside the body behind another exposed side stores
//   U = 1/2 K (d - d0)^2,  K = penalty / h * weight * length of its side,  h = side of the mean triangle,
// and U pushes P and the two corners of the side by -dU/du: equal and opposite forces with no moment. d is the depth below the line of the
// side whose part of the boundary is nearest: neighbouring sides of one body part along the bisector of their corner, where their depths
// are equal, so U has no jump from side to side and none at the inner sides of triangles. This is the energy-conserving potential contact
// of Munjiza and Andrews (2000) with the distance to the exposed boundary in place of the triangle's own potential, which vanishes at
// every corner of a surface and would make a flat one bumpy.
// d0 is 0 where the bodies met by moving. It is not where d jumps because a side was exposed or a joint of the surface is torn: nothing
// gains energy without motion. An edge that breaks while pressed together keeps its overlap (d0 = 0), which `jumped` books. Friction: a
// spring of stiffness K along the side, from where P first touched, cut at mu times the normal force (sticks, then slides).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/archive.hpp"
#include "solver/fdem/contact/near_pairs.hpp"
#include "solver/fdem/contact/surface.hpp"
#include "solver/fdem/contact/touch.hpp"

namespace fracfarm::fdem {

struct ContactSettings {
  double penalty = 0.0;                    // Pa; both sides push, so an edge carries 2 penalty / h, Pa/m
  double friction = 0.0;                   // Coulomb's mu
  std::vector<double> triangle_penalty{};  // Pa, where materials differ; empty: `penalty` everywhere
};

// Undeformed corners of every triangle: rows of 8, x0 z0 x1 z1 x2 z2 x0 z0, m, counter-clockwise. Edge k starts at corner k.
using CornerRows = std::vector<double>;

struct ContactEnergies {
  double stored = 0.0;    // J/m, in overlaps and friction springs now
  double friction = 0.0;  // J/m, dissipated since the start
  double jumped = 0.0;    // J/m, stored since the start without motion: overlaps of edges as they broke, less what left its reach
};

template <class Real>
class Contact {
 public:
  // `neighbour[3 t + k]`: the side across edge k, or -1 on the boundary. All arrays stay with the caller and outlive this.
  Contact(const CornerRows& corners, std::span<const TriangleSide> neighbour, ContactSettings settings);

  // A side can be touched from now on; of an edge between two triangles expose both. An overlap with the side across that is there already
  // goes on pressing, with the stiffness of contact, where a joint pressed until now (an edge that breaks). Where nothing did (`was_joined`
  // false: a crack from the start) it is forgotten.
  void expose(TriangleSide side, bool was_joined = true) { surface_.expose({side, was_joined}); }
  bool any() const { return !surface_.order().empty(); }

  // One step: `displacement` and `force` are rows of 8 of the triangles, m and N/m; contact forces are added to columns 0 to 5. Books
  // energies. Ordered sums: the same bits for any number of threads. The motion since the last call is the step: call it once each.
  void add_forces(const Real* displacement, Real* force);

  const ContactEnergies& energies() const { return energies_; }
  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

  // What the last step saw, for tests and reports.
  const std::vector<Touch>& touches() const { return touches_; }
  const Surface& surface() const { return surface_; }
  const NearPairs& near_pairs() const { return near_; }

 private:
  void find_touches();
  bool belongs_to(const PlanePoint& p, const Place& place, const ExposedSide& side, const Axes& axes) const;
  Touch* last_touch(const Touch& touch);
  RelativeMotion motion_of(const Touch& touch, const TouchPlace& at) const;
  bool just_broke(const Touch& touch) const;
  void remember(Touch& touch, double depth, double reach);
  void push(const Touch& touch, const TouchPlace& at, Real* force) const;
  void let_go();

  double friction_;
  Surface surface_;
  NearPairs near_;
  std::vector<double> stiffness_;      // of triangles, penalty / h, Pa/m; of all if there is only one
  std::vector<Touch> touches_, last_;  // sorted by target, side and point
  std::vector<TouchPlace> places_;     // of touches_
  std::size_t fresh_ = 0;              // sides from here on were exposed since the last step
  std::size_t cursor_ = 0;             // in last_: its first touch of the present target or of one after
  ContactEnergies energies_;
};

}  // namespace fracfarm::fdem
