#include "solver/fdem/mesh/make_mesh.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <complex>
#include <numbers>

#include "common/base/hash.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "tests/solver/fdem/mesh/mesh_checks.hpp"

namespace fracfarm::fdem {
namespace {

MeshChoice pattern_choice(CrackSet set, int id, double element_size = 0.003) {
  MeshChoice choice;
  choice.element_size = element_size;
  choice.seed = static_cast<std::uint64_t>(id);
  choice.cracks = draw_pattern(set, 7, static_cast<std::uint64_t>(id));
  return choice;
}

template <class Row>
std::string_view bytes_of(const std::vector<Row>& rows) {
  return {reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(Row)};
}

std::string digest(const TriangleMesh& mesh) {
  return xxh3_hex(std::string(bytes_of(mesh.nodes)).append(bytes_of(mesh.edge_nodes)).append(bytes_of(mesh.edge_triangles)));
}

double edge_length(const TriangleMesh& mesh, std::size_t e) {
  const auto &p = mesh.nodes[mesh.edge_nodes[e][0]], &q = mesh.nodes[mesh.edge_nodes[e][1]];
  return std::hypot(q[0] - p[0], q[1] - p[1]);
}

}  // namespace

TEST_CASE("meshes of random patterns are sound, follow every crack and have no flat triangle") {
  for (int id = 1; id <= 12; ++id) {
    INFO("pattern " << id);
    CHECK(verdict_on(pattern_choice(CrackSet::orthogonal, id, 0.004)) == "made");
    CHECK(verdict_on(pattern_choice(CrackSet::oblique, id, 0.004)) == "made");
    CHECK(verdict_on(pattern_choice(CrackSet::orthogonal, id + 100, 0.006)) == "made");
  }
}

TEST_CASE("elements have the length that was asked for") {
  for (const double size : {0.003, 0.006}) {
    const MeshResult made = make_mesh(pattern_choice(CrackSet::orthogonal, 3, size));
    REQUIRE(made);
    double sum = 0.0;
    for (std::size_t e = 0; e < made->mesh.edge_nodes.size(); ++e) sum += edge_length(made->mesh, e);
    CHECK(sum / static_cast<double>(made->mesh.edge_nodes.size()) == Approx(size).epsilon(0.015));
    CHECK(static_cast<double>(made->mesh.triangles.size()) == Approx(16700.0 * 0.003 * 0.003 / (size * size)).epsilon(0.02));
  }
}

TEST_CASE("the report says what independent measurement finds") {
  const MeshResult made = make_mesh(pattern_choice(CrackSet::oblique, 4));
  REQUIRE(made);
  CHECK(made->report.smallest_height == Approx(lowest_height(made->mesh)).epsilon(1e-9));
  CHECK(made->report.area_error < 1e-13);
  CHECK(made->report.smallest_angle > 18.0);
  CHECK(made->report.smallest_height > 0.001);
}

TEST_CASE("the same choice gives the same mesh, another seed another one, to the same lines") {
  MeshChoice choice = pattern_choice(CrackSet::orthogonal, 5, 0.005);
  const MeshResult first = make_mesh(choice), again = make_mesh(choice);
  choice.seed = 99;
  const MeshResult other = make_mesh(choice);
  REQUIRE((first && again && other));
  CHECK(first->mesh == again->mesh);
  CHECK_FALSE(first->mesh == other->mesh);
  CHECK(first->cracks == other->cracks);
  CHECK(std::count(first->mesh.edge_kind.begin(), first->mesh.edge_kind.end(), EdgeKind::crack) ==
        std::count(other->mesh.edge_kind.begin(), other->mesh.edge_kind.end(), EdgeKind::crack));
}

// Any compiler, instruction set and host must give these bits. A change of the mesher on purpose changes them, and every record made with
// it.
TEST_CASE("the meshes of two patterns are these to the bit") {
  const MeshResult orthogonal = make_mesh(pattern_choice(CrackSet::orthogonal, 1)),
                   oblique = make_mesh(pattern_choice(CrackSet::oblique, 1));
  REQUIRE((orthogonal && oblique));
  CHECK(digest(orthogonal->mesh) == "79099808c7beafb80d155b9ec1242fe3");
  CHECK(digest(oblique->mesh) == "509b2d5b6c87756ab72ab837abd00a9f");
}

// Away from sides and cracks no direction is preferred: the sums over all edges of exp(i n theta) stay near those of independent
// directions.
TEST_CASE("edges point everywhere alike") {
  std::array<std::complex<double>, 13> sums{};
  std::array<double, 12> bins{};
  double count = 0;
  for (int id = 1; id <= 6; ++id) {
    MeshChoice choice;
    choice.seed = static_cast<std::uint64_t>(id);
    const MeshResult made = make_mesh(choice);
    REQUIRE(made);
    for (std::size_t e = 0; e < made->mesh.edge_nodes.size(); ++e) {
      const auto &p = made->mesh.nodes[made->mesh.edge_nodes[e][0]], &q = made->mesh.nodes[made->mesh.edge_nodes[e][1]];
      if (std::min({p[0], p[1], 0.25 - p[0], 0.25 - p[1]}) < 0.012) continue;
      double angle = std::atan2(q[1] - p[1], q[0] - p[0]);
      for (int n = 2; n <= 12; n += 2) sums[static_cast<std::size_t>(n)] += std::polar(1.0, n * angle);
      if (angle < 0) angle += std::numbers::pi;
      ++bins[static_cast<std::size_t>(std::min(11.0, angle / std::numbers::pi * 12))];
      ++count;
    }
  }
  for (int n = 2; n <= 12; n += 2) {
    INFO("n = " << n);
    CHECK(std::abs(sums[static_cast<std::size_t>(n)]) / count < 0.012);  // a lattice has 1 at n = 6, patches of lattice some 0.1
  }
  double chi_square = 0.0;
  for (const double bin : bins) chi_square += (bin - count / 12) * (bin - count / 12) / (count / 12);
  CHECK(chi_square <
        45.0);  // 11 degrees of freedom; neighbouring edges hang together, which makes it some 2 times that of independent ones
}

TEST_CASE("neighbours of a node are no regular hexagon: the mesh has no patches of lattice") {
  MeshChoice choice;
  const MeshResult made = make_mesh(choice);
  REQUIRE(made);
  std::vector<std::complex<double>> order(made->mesh.nodes.size());
  std::vector<double> degree(made->mesh.nodes.size());
  for (std::size_t e = 0; e < made->mesh.edge_nodes.size(); ++e) {
    const auto [a, b] = made->mesh.edge_nodes[e];
    const auto &p = made->mesh.nodes[a], &q = made->mesh.nodes[b];
    for (const int node : {a, b}) order[node] += std::polar(1.0, 6 * std::atan2(q[1] - p[1], q[0] - p[0])), ++degree[node];
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) sum += std::abs(order[i]) / degree[i];
  CHECK(sum / static_cast<double>(order.size()) < 0.65);  // 1 in a lattice, 0.44 before smoothing, 0.56 after
}

TEST_CASE("edges lie along every layer, through cracks and where a crack lies on it") {
  MeshChoice choice;
  choice.element_size = 0.005;
  choice.layers = {0.07, 0.1801, 0.1};
  choice.cracks = {{0.05, 0.02, 0.09, 0.22}, {0.1, 0.1, 0.2, 0.1}, {0.2, 0.182, 0.24, 0.22}};
  CHECK(verdict_on(choice) == "made");
}

TEST_CASE("long thin bodies and large and tiny ones are meshed") {
  CHECK(verdict_on({0.3, 0.01, 0.003, 1, {{0.1, 0.0, 0.1, 0.005}}, {}}) == "made");
  CHECK(verdict_on({0.0061, 0.2, 0.003, 1, {{0.0, 0.1, 0.006, 0.1}}, {}}) == "made");
  CHECK(verdict_on({900.0, 700.0, 20.0, 1, {{100.0, 100.0, 500.0, 400.0}}, {}}) == "made");
  CHECK(verdict_on({1e-3, 1e-3, 3e-5, 1, {{0.0, 5e-4, 5e-4, 5e-4}}, {}}) == "made");
}

TEST_CASE("triangles that follow each other lie beside each other") {
  const MeshResult made = make_mesh(pattern_choice(CrackSet::orthogonal, 2));
  REQUIRE(made);
  double sum = 0.0;
  for (const auto& [left, right] : made->mesh.edge_triangles) sum += std::abs(left - right);
  CHECK(sum / static_cast<double>(made->mesh.edge_triangles.size()) < 500.0);  // a third of 16,700 in a random order
  int largest = 0;
  for (const auto& triangle : made->mesh.triangles)
    for (const int node : triangle) {
      CHECK(node <= largest);  // nodes are numbered as triangles first touch them
      largest = std::max(largest, node + 1);
    }
}

TEST_CASE("a scene's mesh depends on its body, cracks, layers and settings of FDEM") {
  Scene scene;
  scene.width = 0.1;
  scene.height = 0.08;
  scene.layers = {{0.03, {}}, {0.08, {}}};
  scene.cracks = {{0.02, 0.05, 0.05, 0.05}};
  scene.fdem.element_size = 0.005;
  scene.fdem.mesh_seed = 17;
  const MeshChoice choice = mesh_choice(scene);
  CHECK((choice.width == 0.1 && choice.height == 0.08 && choice.element_size == 0.005 && choice.seed == 17));
  CHECK((choice.layers == std::vector<double>{0.03} && choice.cracks == scene.cracks));
  CHECK(verdict_on(choice) == "made");
}

}  // namespace fracfarm::fdem
