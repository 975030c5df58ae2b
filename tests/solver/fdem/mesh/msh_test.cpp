#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "solver/fdem/mesh/msh_text.hpp"
#include "tests/solver/fdem/mesh/mesh_checks.hpp"

namespace fracfarm::fdem {
namespace {

// Two by two squares of 1 m, each cut in two; a body of 2 x 2 m.
const std::string nodes_22 = "$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 0 2 0\n8 1 2 0\n9 2 2 0\n$EndNodes\n";
const std::string format_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string elements_22 =
    "$Elements\n9\n1 15 2 0 1 1\n2 2 2 0 1 1 2 5\n3 2 2 0 1 1 5 4\n4 2 2 0 1 2 3 6\n5 2 2 0 1 2 6 5\n6 2 2 0 1 4 5 8\n7 2 2 0 1 4 8 7\n8 2 "
    "2 0 1 5 6 9\n"
    "9 2 2 0 1 5 9 8\n$EndElements\n";
const std::string file_22 = format_22 + nodes_22 + elements_22;

// The same in 4.1, in two blocks of nodes, with tags that have gaps and a parametric block; the curve 7 is the crack 4-5 of the group.
const std::string file_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 3 \"cracks\"\n2 4 \"body\"\n$EndPhysicalNames\n"
    "$Entities\n1 2 1 0\n1 0 0 0 0\n7 0 1 0 1 1 0 1 3 2 1 -1\n8 0 0 0 2 0 0 0 2 1 -1\n1 0 0 0 2 2 0 1 4 1 8\n$EndEntities\n"
    "$Nodes\n2 9 1 90\n1 8 1 3\n10\n20\n30\n0 0 0 0\n1 0 0 0.5\n2 0 0 1\n2 1 0 6\n40\n50\n60\n70\n80\n90\n0 1 0\n1 1 0\n2 1 0\n0 2 0\n1 2 "
    "0\n2 2 0\n$EndNodes\n"
    "$Elements\n3 10 1 10\n1 7 1 1\n1 40 50\n1 8 1 1\n2 10 20\n2 1 2 8\n3 10 20 50\n4 10 50 40\n5 20 30 60\n6 20 60 50\n7 40 50 80\n8 40 "
    "80 70\n9 50 60 90\n"
    "10 50 90 80\n$EndElements\n";

MeshChoice squares(std::vector<Segment> cracks = {}) { return {2.0, 2.0, 1.0, 1, std::move(cracks), {}}; }

std::size_t cracked(const MeshResult& made) {
  return static_cast<std::size_t>(std::count(made->mesh.edge_kind.begin(), made->mesh.edge_kind.end(), EdgeKind::crack));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

std::string reason(const std::string& bytes, const MeshChoice& choice = squares()) {
  const MeshResult made = read_msh(bytes, choice);
  return made ? "read" : made.error();
}

using Catch::Contains;

}  // namespace

TEST_CASE("a mesh that is written is read back to the bit") {
  MeshChoice choice{0.1, 0.08, 0.004, 5, {{0.02, 0.03, 0.07, 0.05}, {0.05, 0.01, 0.05, 0.07}, {0.03, 0.0301, 0.06, 0.031}}, {0.02}};
  const MeshResult made = make_mesh(choice);
  REQUIRE(made);
  const MeshResult read = read_msh(write_msh(made->mesh), choice);
  REQUIRE(read);
  CHECK((read->mesh == made->mesh));
  CHECK(read->report.smallest_height == made->report.smallest_height);
}

TEST_CASE("MSH 2.2 is read, and edges on a crack of the scene are cracked") {
  const MeshResult made = read_msh(file_22, squares({{0.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 2.0, 2.0}}));
  REQUIRE(made);
  CHECK(made->mesh.nodes.size() == 9);
  CHECK(made->mesh.triangles.size() == 8);
  CHECK(made->mesh.edge_nodes.size() == 8);
  CHECK(cracked(made) == 2);
  CHECK(fault_of(made->mesh, squares({{0.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 2.0, 2.0}}), 0.1).empty());
}

TEST_CASE("MSH 4.1 is read, and the physical group named cracks says which edges are") {
  const MeshResult made = read_msh(file_41, squares({{0.0, 1.1, 1.0, 0.95}}));
  REQUIRE(made);
  CHECK(made->mesh.triangles.size() == 8);
  REQUIRE(cracked(made) == 1);
  CHECK(reason(replaced(file_41, "\"cracks\"", "\"other\""), squares({{0.0, 1.1, 1.0, 0.95}})) ==
        "crack 0 has no edge of the mesh along it at (0.166667, 1.075) m, within 2 mm");
}

TEST_CASE("triangles that turn clockwise are turned round, and nodes without triangle left out") {
  const MeshResult turned = read_msh(replaced(file_22, "1 1 2 5\n", "1 1 5 2\n"), squares());
  REQUIRE(turned);
  CHECK(fault_of(turned->mesh, squares()).empty());
  const MeshResult more =
      read_msh(replaced(replaced(file_22, "$Nodes\n9\n", "$Nodes\n10\n"), "9 2 2 0\n", "9 2 2 0\n10 0.7 0.3 0\n"), squares());
  REQUIRE(more);
  CHECK(more->mesh.nodes.size() == 9);
}

TEST_CASE("nodes beside a side by rounding lie on it") {
  const MeshResult made = read_msh(replaced(file_22, "6 2 1 0", "6 1.9999999999 1 0"), squares());
  REQUIRE(made);
  CHECK(made->report.area_error == 0.0);
}

TEST_CASE("what a mesh file lacks is said with its place") {
  CHECK_THAT(reason(""), Contains("no $MeshFormat"));
  CHECK_THAT(reason("hello"), Contains("line 1: 'hello' stands where a section must begin"));
  CHECK_THAT(reason(replaced(file_22, "2.2 0 8", "3.0 0 8")), Contains("line 2: version 3.0"));
  CHECK_THAT(reason(replaced(file_22, "2.2 0 8", "2.2 1 8")), Contains("binary"));
  CHECK_THAT(reason(format_22 + nodes_22), Contains("no triangle"));
  CHECK_THAT(reason(format_22 + elements_22), Contains("has the node 1, which is not there"));
  CHECK_THAT(reason(replaced(file_22, "1 5 4\n", "1 5 77\n")), Contains("has the node 77, which is not there"));
  CHECK_THAT(reason(replaced(file_22, "1 5 4\n", "1 5 -3\n")), Contains("node -3"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 nan 1 0\n")), Contains("finite"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 x 1 0\n")), Contains("line 10: a coordinate must stand here"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 1 1 0.2\n")), Contains("z = 0.2"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "4 1 1 0\n")), Contains("node 4 is given twice"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 0 1 0\n")), Contains("two nodes lie at (0, 1)"));
  CHECK_THAT(reason(replaced(file_22, "9 2 2 0\n$End", "9 2.5 2 0\n$End")), Contains("outside the body"));
  CHECK_THAT(reason(replaced(file_22, "3 2 2 0 1 1 5 4", "3 3 2 0 1 1 2 5 4")), Contains("element of type 3; allowed"));
  CHECK_THAT(reason(replaced(file_22, "$EndNodes", "$EndNode")), Contains("$EndNodes is missing"));
  CHECK_THAT(reason(replaced(file_22, "$Nodes\n9\n", "$Nodes\n99999999999\n")), Contains("the number of nodes"));
}

TEST_CASE("meshes that are no partition of the body are refused") {
  CHECK_THAT(reason(replaced(replaced(file_22, "$Elements\n9\n", "$Elements\n8\n"), "9 2 2 0 1 5 9 8\n", "")),
             Contains("ends at an edge inside"));
  CHECK_THAT(reason(replaced(file_22, "9 2 2 0 1 5 9 8\n", "9 2 2 0 1 5 6 9\n")), Contains("two triangles overlap"));
  CHECK_THAT(reason(replaced(file_22, "9 2 2 0 1 5 9 8\n", "9 2 2 0 1 5 9 9\n")), !Contains("read"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 1.95 1 0\n")), Contains("is 35.4 mm high; at least 133 mm"));
  CHECK_THAT(reason(replaced(file_22, "5 1 1 0\n", "5 0.2 2 0\n")), !Contains("read"));
  CHECK_THAT(reason(file_22, {2.5, 2.0, 1.0, 1, {}, {}}), Contains("ends at an edge inside"));
  CHECK_THAT(reason(file_22, {2.0, 2.0, 1.0, 1, {}, {0.7}}), Contains("both sides of the layer boundary at 0.7 m"));
  CHECK(reason(file_22, {2.0, 2.0, 1.0, 1, {}, {1.0}}) == "read");
}

TEST_CASE("cracks that the mesh does not follow are refused with their number") {
  CHECK_THAT(reason(file_22, squares({{0.0, 1.0, 1.0, 1.0}, {0.2, 0.5, 1.5, 0.5}})), Contains("crack 1 has no edge"));
  CHECK_THAT(reason(file_22, squares({{0.0, 1.0, 1.5, 1.0}})), Contains("crack 0 has no edge"));
  CHECK(reason(file_22, squares({{-1.0, 1.0, 3.0, 1.0}})) == "read");
  CHECK_THAT(reason(file_41, squares()), Contains("with no crack of the scene within"));
}

TEST_CASE("mutilated files never crash the reader, and what it takes is sound") {
  RandomStream random(11, 1, 1);
  static constexpr std::array<std::string_view, 9> pieces{"-1", "1e400", "nan",          "$Nodes", "99999999999999999999",
                                                          "0",  "\n",    "$EndElements", "7"};
  int read = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string bytes = round % 2 ? file_22 : file_41;
    for (int change = random.integer(1, 3); change > 0 && !bytes.empty(); --change) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
      const int kind = random.integer(0, 4);
      if (kind == 0) bytes.resize(at + 1);
      if (kind == 1) bytes[at] = static_cast<char>(random.integer(0, 255));
      if (kind == 2) bytes.insert(at, pieces[static_cast<std::size_t>(random.integer(0, 8))]);
      if (kind == 3) bytes.erase(at, static_cast<std::size_t>(random.integer(1, 20)));
      if (kind == 4) bytes[at] = static_cast<char>('0' + random.integer(0, 9));
    }
    const MeshChoice choice = squares(round % 2 ? std::vector<Segment>{} : std::vector<Segment>{{0, 1, 1, 1}});
    const MeshResult made = read_msh(bytes, choice);
    read += made.has_value();
    CHECK((made ? fault_of(made->mesh, choice, 1.01).empty() : !made.error().empty()));
  }
  CHECK(read > 100);
}

}  // namespace fracfarm::fdem
