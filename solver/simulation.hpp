// The seam between the time loop and a method: stable_dt, start, step, sample, save, load. The loop knows no equations, a method knows no
// criteria, files or clocks beyond its own stage times.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/base/result.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/triangle_mesh.hpp"
#include "solver/archive.hpp"
#include "solver/damage_history.hpp"
#include "solver/rules.hpp"
#include "solver/sample.hpp"

namespace fracfarm {

struct GridLayout {
  std::vector<double> x, z;         // node coordinates, m
  std::vector<unsigned char> mask;  // 1 on nodes of the initial cracks
};

struct MeshLayout {
  TriangleMesh mesh;
  std::vector<double> break_time;         // s by edge, not a number where it never broke
  std::vector<unsigned char> break_mode;  // BreakMode by edge
};

using Layout = std::variant<GridLayout, MeshLayout>;  // where the values of stored_damage() stand

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual double stable_dt() const = 0;  // s, edge of the scheme
  // Fields at t = 0, forces, and the energy that was there before the boundary moved.
  virtual Result<void> start(double dt) = 0;
  // From time n dt to (n + 1) dt. Errors: SOLVER_NUMERIC.
  virtual Result<void> step(long long n, double dt) = 0;

  virtual double mean_stress_zz() const = 0;  // Pa, after each step
  virtual SampleRow sample(long long n, double dt) const = 0;
  virtual std::vector<float> stored_damage() const = 0;  // as a record keeps it: by node of a grid, by edge of a mesh
  virtual Layout layout() const = 0;

  // Exactly what a restart needs. After load, steps give the same bits as if the run had never stopped.
  virtual void save(ArchiveWriter& archive) const = 0;
  virtual bool load(ArchiveReader& archive, long long n, double dt) = 0;

  virtual std::map<std::string, double> stage_seconds() const = 0;
  virtual std::string kernel() const = 0;
};

// Nodes of a grid whose damage is above a threshold, kept up to date from call to call.
struct CrackMarks {
  std::vector<unsigned char> cracked;  // 1 or 0 by node
  std::vector<int> changed;            // nodes that changed when they were last brought up to date
  long long as_of = -1;                // when that was: the simulation's own count
};

// Damage on the nodes of a regular grid, row 0 at the bottom.
class GridSimulation : public Simulation {
 public:
  virtual int columns() const = 0;
  virtual int rows() const = 0;
  virtual std::vector<double> x() const = 0;  // m
  virtual std::vector<double> z() const = 0;  // m
  virtual std::vector<unsigned char> mask() const = 0;
  virtual void copy_damage(std::vector<double>& values) const = 0;
  // Brings the marks up to date. The threshold is the same each time.
  virtual void mark_cracked(double threshold, CrackMarks& marks) const = 0;
  virtual bool crack_reaches(Side side, double threshold) const = 0;
  Layout layout() const final { return GridLayout{x(), z(), mask()}; }
};

enum class BreakMode : unsigned char { none = 0, tension = 1, shear = 2, mixed = 3 };

// Damage on the edges between the triangles of a mesh: in [0, 1], 1 is broken; 2 on edges that were open from the start.
class MeshSimulation : public Simulation {
 public:
  virtual const TriangleMesh& mesh() const = 0;
  // Appends every edge whose stored damage may have changed since this was last asked, or since the start or a load.
  virtual void take_damage_changes(std::vector<EdgeDamage>& changes) const = 0;
  virtual std::vector<double> break_time() const = 0;         // s by edge, not a number where it never broke
  virtual std::vector<unsigned char> break_mode() const = 0;  // BreakMode by edge
  Layout layout() const final { return MeshLayout{mesh(), break_time(), break_mode()}; }
};

std::unique_ptr<GridSimulation> make_phase_field(const Scene& scene, const Rules& rules = {});

}  // namespace fracfarm
