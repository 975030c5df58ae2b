#include "solver/fdem/mesh/make_mesh.hpp"

#include "common/base/clock.hpp"
#include "solver/fdem/mesh/assemble.hpp"
#include "solver/fdem/mesh/gate.hpp"
#include "solver/fdem/mesh/relax.hpp"
#include "solver/fdem/mesh/repair.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double repair_reach = 1.0;  // of the element size: a crack that was led further off is not what was asked for
constexpr int smoothing_sweeps = 2;   // edges then vary by 12 % about their mean; ten sweeps reach 11 %

// The lines' vertices first, by their numbers, then the free points along a Hilbert curve.
bool insert_points(Triangulation& triangles, const Lattice& lattice, const CrackGraph& lines, const std::vector<Vec>& free_points) {
  int near = 0;
  for (std::size_t v = 0; v < lines.vertices().size(); ++v) {
    const int point = triangles.insert(lattice.nearest(lines.vertices()[v].x, lines.vertices()[v].z), near);
    if (point != static_cast<int>(v)) return false;
    near = triangles.triangle_of(point);
  }
  std::vector<std::uint64_t> order;
  const double scale = 65535.0 / std::max(lattice.upper_right().x, lattice.upper_right().z) / lattice.unit();
  for (std::size_t i = 0; i < free_points.size(); ++i) {
    const auto x = static_cast<std::uint32_t>(free_points[i].x * scale), z = static_cast<std::uint32_t>(free_points[i].z * scale);
    order.push_back(static_cast<std::uint64_t>(hilbert_index(x, z)) << 32 | i);
  }
  std::sort(order.begin(), order.end());
  for (const std::uint64_t key : order) {
    const Vec p = free_points[key & 0xffffffffu];
    near = triangles.triangle_of(triangles.insert(lattice.nearest(p.x, p.z), near));
  }
  return true;
}

Soup soup_of(const Triangulation& triangles, const Lattice& lattice, const CrackGraph& lines) {
  Soup soup;
  for (const Point p : triangles.points()) soup.nodes.push_back({lattice.x(p), lattice.z(p)});
  for (const Triangle& triangle : triangles.triangles()) soup.triangles.push_back(triangle.corner);
  for (const GraphEdge& edge : lines.edges())
    if (edge.kind == LineKind::crack) soup.crack_edges.emplace_back(edge.a, edge.b);
  return soup;
}

MeshResult refuse(std::string reason) { return tl::unexpected<std::string>(std::move(reason)); }

MeshResult mesh_of(const MeshChoice& choice) {
  if (std::string reason = refusal(choice); !reason.empty()) return refuse(std::move(reason));
  RepairedCracks repaired = repair(choice);
  const CrackGraph lines = draw_lines(choice.width, choice.height, choice.element_size, choice.layers, repaired.cracks);
  if (lines.tangled()) return refuse("the cracks are too tangled to be parted by half an element");
  const Lattice lattice(choice.width, choice.height, choice.layers);
  const Spacing spacing = spacing_of(choice.element_size);
  const std::vector<Vec> free_points = throw_points(choice.width, choice.height, spacing, lines, choice.seed);
  Triangulation triangles(lattice.upper_right());
  if (!insert_points(triangles, lattice, lines, free_points)) return refuse("two points of the lines fall together");
  for (const GraphEdge& edge : lines.edges())
    if (!triangles.constrain(edge.a, edge.b)) return refuse("an edge of a crack, side or layer cannot be made");
  const Relaxation relaxation{triangles, static_cast<int>(lines.vertices().size()), choice.element_size / lattice.unit()};
  const bool flipped = triangles.restore();
  fill_gaps(triangles, lattice, lines, spacing);
  if (!flipped || !smooth(relaxation, smoothing_sweeps) || !mend_flat(relaxation)) return refuse("the triangulation does not settle");
  auto mesh = assemble(soup_of(triangles, lattice, lines));
  if (!mesh) return refuse(mesh.error());
  MadeMesh made{std::move(*mesh), std::move(repaired.cracks), {}};
  made.report.moved = repaired.moved;
  made.report.trimmed = repaired.trimmed;
  made.report.extended = repaired.extended;
  made.report.merged = lines.merged();
  if (std::string reason = gate(made.mesh, choice, made.report); !reason.empty()) return refuse(std::move(reason));
  if (std::string reason = strayed_crack(made.mesh, choice, repair_reach * choice.element_size); !reason.empty())
    return refuse(std::move(reason));
  return made;
}

}  // namespace

MeshResult make_mesh(const MeshChoice& choice) {
  SystemClock clock;
  const double start = clock.monotonic_s();
  MeshResult made = mesh_of(choice);
  if (made) made->report.seconds = clock.monotonic_s() - start;
  return made;
}

}  // namespace fracfarm::fdem
