#include "solver/fdem/mesh/repair.hpp"

#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/crack_graph.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double h = 0.004;  // repairs reach 2 mm

RepairedCracks repaired(std::vector<Segment> cracks, std::vector<double> layers = {}) {
  return repair({0.1, 0.1, h, 1, std::move(cracks), std::move(layers)});
}

// The graph's promise: vertices half an element apart, edges 0.35 clear of vertices that they do not end in.
void check_clearance(const CrackGraph& graph) {
  const auto& v = graph.vertices();
  double closest = 1e300, nearest = 1e300;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, distance(v[i], v[j]));
  for (const GraphEdge& edge : graph.edges())
    for (int i = 0; i < static_cast<int>(v.size()); ++i)
      if (i != edge.a && i != edge.b) nearest = std::min(nearest, distance_to(v[i], v[edge.a], v[edge.b]));
  CHECK(closest >= 0.5 * h * (1 - 1e-9));
  CHECK(nearest >= 0.35 * h * (1 - 1e-9));
}

}  // namespace

TEST_CASE("a parallel crack within half an element is moved onto the older one and united with it") {
  const RepairedCracks mended = repaired({{0.02, 0.05, 0.06, 0.05}, {0.04, 0.0519, 0.08, 0.0519}});
  CHECK(mended.cracks == std::vector<Segment>{{0.02, 0.05, 0.08, 0.05}});
  CHECK(mended.moved == 1);
  CHECK(repaired({{0.02, 0.05, 0.06, 0.05}, {0.04, 0.0521, 0.08, 0.0521}}).cracks.size() == 2);
  CHECK(repaired({{0.02, 0.05, 0.04, 0.05}, {0.05, 0.0519, 0.08, 0.0519}}).cracks.size() == 2);  // they do not overlap
}

TEST_CASE("an end short of a crack is extended to it, one just past it trimmed back") {
  const Segment across{0.02, 0.05, 0.08, 0.05};
  const RepairedCracks extended = repaired({across, {0.05, 0.0518, 0.05, 0.09}});
  CHECK(extended.cracks[1] == Segment{0.05, 0.05, 0.05, 0.09});
  CHECK((extended.extended == 1 && extended.trimmed == 0));
  const RepairedCracks trimmed = repaired({across, {0.05, 0.0482, 0.05, 0.09}});
  CHECK(trimmed.cracks[1] == Segment{0.05, 0.05, 0.05, 0.09});
  CHECK((trimmed.extended == 0 && trimmed.trimmed == 1));
  const RepairedCracks clear = repaired({across, {0.05, 0.0521, 0.05, 0.09}});
  CHECK((clear.extended == 0 && clear.trimmed == 0));
}

TEST_CASE("an oblique end is extended along its own direction") {
  const RepairedCracks mended = repaired({{0.02, 0.05, 0.08, 0.05}, {0.06, 0.07, 0.0415, 0.0515}});
  CHECK(mended.cracks[1].x1 == Approx(0.04).margin(1e-12));
  CHECK(mended.cracks[1].z1 == Approx(0.05).margin(1e-12));
}

TEST_CASE("two ends near one corner both go to it") {
  const RepairedCracks mended = repaired({{0.02, 0.05, 0.049, 0.05}, {0.05, 0.051, 0.05, 0.09}});
  CHECK(mended.cracks[0] == Segment{0.02, 0.05, 0.05, 0.05});
  CHECK(mended.cracks[1] == Segment{0.05, 0.05, 0.05, 0.09});
}

TEST_CASE("ends near sides and layers end on them, cracks along sides go, along layers lie on them") {
  const RepairedCracks mended =
      repaired({{0.001, 0.02, 0.04, 0.02}, {0.03, 0.0415, 0.03, 0.08}, {0.06, 0.0412, 0.09, 0.0408}, {0.02, 0.001, 0.08, 0.001}}, {0.04});
  REQUIRE(mended.cracks.size() == 3);
  CHECK(mended.cracks[0].x0 == 0.0);
  CHECK(mended.cracks[1].z0 == 0.04);
  CHECK(mended.cracks[2] == Segment{0.06, 0.04, 0.09, 0.04});
  CHECK(mended.moved == 2);
}

// In these patterns ends would pull each other along, round after round, to 4 mm from where they were drawn.
TEST_CASE("repairs that follow each other keep every crack near to where it was drawn") {
  for (const std::uint64_t id : {210, 252}) {
    const std::vector<Segment> drawn = draw_pattern(CrackSet::oblique, 1, id);
    const RepairedCracks mended = repair({0.25, 0.25, 0.003, 1, drawn, {}});
    for (const Segment& crack : drawn)
      for (int k = 0; k <= 50; ++k) {
        const Vec p = along(first(crack), last(crack), k / 50.0);
        double nearest = 1e300;
        for (const Segment& other : mended.cracks) nearest = std::min(nearest, distance_to(p, first(other), last(other)));
        CHECK(nearest < 0.003);
      }
  }
}

TEST_CASE("cracks that are far enough apart are left to the bit") {
  const std::vector<Segment> cracks{{0.02, 0.05, 0.08, 0.05}, {0.05, 0.03, 0.05, 0.09}, {0.01, 0.01, 0.03, 0.04}};
  const RepairedCracks mended = repaired(cracks);
  CHECK(mended.cracks == cracks);
  CHECK(mended.moved + mended.trimmed + mended.extended == 0);
}

TEST_CASE("lines of any kind come out of the graph with clearance") {
  RandomStream random(8, 1, 1);
  for (int round = 0; round < 30; ++round) {
    std::vector<Segment> cracks;
    for (int i = 0; i < 30; ++i) {
      const double x = random.uniform(0.0, 0.1), z = random.uniform(0.0, 0.1);
      cracks.push_back({x, z, random.uniform(0.0, 0.1), round % 2 ? z : random.uniform(0.0, 0.1)});
    }
    const CrackGraph graph = draw_lines(0.1, 0.1, h, {0.03}, cracks);
    INFO("round " << round);
    REQUIRE_FALSE(graph.tangled());
    check_clearance(graph);
  }
}

TEST_CASE("a crossing becomes a vertex of both cracks and moves none of them") {
  const CrackGraph graph = draw_lines(0.1, 0.1, h, {}, {{0.02, 0.05, 0.08, 0.05}, {0.0511, 0.02, 0.0511, 0.08}});
  int at_crossing = 0, ends = 0;
  for (const GraphEdge& edge : graph.edges()) {
    if (edge.kind != LineKind::crack) continue;
    const Vec a = graph.vertices()[edge.a], b = graph.vertices()[edge.b];
    CHECK(((a.x == 0.0511 && b.x == 0.0511) || (a.z == 0.05 && b.z == 0.05)));
    for (const Vec p : {a, b})
      at_crossing += p.x == 0.0511 && p.z == 0.05, ends += p.x == 0.02 || p.z == 0.02 || p.x == 0.08 || p.z == 0.08;
  }
  CHECK(at_crossing == 4);
  CHECK(ends == 4);
  CHECK(graph.merged() == 0);
}

}  // namespace fracfarm::fdem
