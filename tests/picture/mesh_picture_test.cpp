#include "common/picture/mesh_picture.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace fracfarm;
using namespace fracfarm::picture;

namespace {

// A square of 1 m in two triangles, parted by the diagonal from the origin up.
TriangleMesh square() {
  return {{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}, {{0, 1, 2}, {0, 2, 3}}, {{0, 2}}, {{1, 0}}, {EdgeKind::joint}};
}

Colour middle(const TriangleMesh& mesh, float damage) {
  const std::vector<float> damages{damage};
  return draw_mesh(mesh, damages, 101).at(50, 50);
}

}  // namespace

TEST_CASE("an edge has the colour of its damage, and runs up from the lower left") {
  const TriangleMesh mesh = square();
  CHECK(middle(mesh, 2.0f) == initial_crack_colour);
  CHECK(middle(mesh, 1.0f) == broken_colour);
  CHECK(middle(mesh, 0.5f) == softening(0.5));
  const std::vector<float> broken{1.0f};
  const Canvas canvas = draw_mesh(mesh, broken, 101);
  CHECK(canvas.at(10, 90) == broken_colour);
  CHECK(canvas.at(90, 90) == white);
}

TEST_CASE("a whole edge is no more than a line of the mesh, which a small picture leaves out") {
  const Colour line = middle(square(), 0.0f);
  CHECK(line.r > 180);
  CHECK(line.r < 255);
  TriangleMesh fine = square();
  fine.triangles.resize(5000, fine.triangles.front());
  CHECK(middle(fine, 0.0f) == white);
}

TEST_CASE("without damage a mesh shows its initial cracks") {
  TriangleMesh mesh = square();
  CHECK(draw_mesh(mesh, {}, 101).at(50, 50).r > 180);
  mesh.edge_kind[0] = EdgeKind::crack;
  CHECK(draw_mesh(mesh, {}, 101).at(50, 50) == initial_crack_colour);
}

TEST_CASE("a mesh keeps its proportions within reason") {
  TriangleMesh mesh = square();
  CHECK(draw_mesh(mesh, {}, 100).height() == 100);
  for (auto& node : mesh.nodes) node[1] *= 0.5;
  CHECK(draw_mesh(mesh, {}, 100).height() == 50);
  for (auto& node : mesh.nodes) node[1] *= 1e-6;
  CHECK(draw_mesh(mesh, {}, 100).height() == 24);
  for (auto& node : mesh.nodes) node[1] *= 1e12;
  CHECK(draw_mesh(mesh, {}, 100).height() == 300);
}
