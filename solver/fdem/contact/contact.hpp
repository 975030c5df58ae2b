// Contact between broken edges: which pairs of triangles may touch (cells of linear cost), and the potential contact force with Coulomb
// friction between them (Munjiza 2004; Munjiza, Knight and Rougier 2011). Knows nothing of joints, laws or time loops.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/archive.hpp"

namespace fracfarm::fdem {

struct ContactSettings {
  double penalty = 0.0;   // Pa
  double friction = 0.0;  // Coulomb's mu
};

// Undeformed corners of every triangle: rows of 8, x0 z0 x1 z1 x2 z2 x0 z0, m. Edge k goes from corner k to corner k + 1.
using CornerRows = std::vector<double>;

// A side of a triangle: edge k of triangle t, as 3 t + k.
using TriangleSide = int;

// The triangles in motion: rows of 8 as CornerRows.
template <class Real>
struct Motion8 {
  const Real* displacement = nullptr;  // m
  const Real* velocity = nullptr;      // m/s
};

struct ContactEnergies {
  double stored = 0.0;    // J/m, potential of the penetration now
  double friction = 0.0;  // J/m, dissipated since the start
};

template <class Real>
class Contact {
 public:
  // `neighbour[3 t + k]`: the side across edge k, or -1 on the boundary. All arrays stay with the caller and outlive this.
  Contact(const CornerRows& corners, std::span<const TriangleSide> neighbour, ContactSettings settings);

  // Both sides of a broken edge (or one side of the boundary) can be touched from now on.
  void expose(TriangleSide side);
  bool any() const { return !exposed_.empty(); }

  // Adds contact forces (N/m) to rows of 8 of the triangles, the last two unused, and books energies over dt. Ordered sums: the same bits
  // for any number of threads.
  void add_forces(const Motion8<Real>& motion, double dt, Real* force);

  const ContactEnergies& energies() const { return energies_; }
  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  std::vector<TriangleSide> exposed_;
  ContactEnergies energies_;
};

}  // namespace fracfarm::fdem
