// The cells find what brute force finds, and the lists with margins never lose a touch.
#include "solver/fdem/contact/search.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "common/base/random.hpp"
#include "solver/fdem/contact/near_pairs.hpp"
#include "tests/solver/fdem/contact/bodies.hpp"

using namespace fracfarm;
using namespace fracfarm::fdem;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double h = 3e-3;

// Loose triangles of many sizes and turns in a box, all sides exposed.
struct Debris {
  Triangles<double> triangles;
  std::vector<SideNow> now;

  Debris(std::uint64_t id, int count, double box) {
    RandomStream random(5, id, 1);
    for (int t = 0; t < count; ++t) {
      const double x = random.uniform(0.0, box), z = random.uniform(-0.5 * box, 0.5 * box), size = h * random.uniform(0.4, 1.2);
      const double turn = random.uniform(0.0, 6.28), c = size * std::cos(turn), s = size * std::sin(turn);
      triangles.add({{{x, z}, {x + c, z + s}, {x + 0.4 * c - 0.8 * s, z + 0.4 * s + 0.8 * c}}}, t);
    }
  }
  Surface surface() const {
    Surface all(triangles.corners, triangles.neighbour);
    for (std::size_t s = 0; s < triangles.neighbour.size(); ++s) all.expose({static_cast<int>(s), 0});
    all.commit();
    return all;
  }
};

std::vector<SideNow> places(const Surface& surface, const Triangles<double>& triangles) {
  std::vector<SideNow> now;
  for (const ExposedSide& side : surface.sides()) {
    const int t = side.triangle, k = side.id % 3, l = (k + 1) % 3;
    now.push_back({triangles.x(t, k), triangles.z(t, k), triangles.x(t, l), triangles.z(t, l)});
  }
  return now;
}

std::vector<SidePair> brute_force(const Surface& surface, const std::vector<SideNow>& now, double margin) {
  std::vector<SidePair> pairs;
  for (std::size_t u = 0; u < now.size(); ++u)
    for (std::size_t v = 0; v < now.size(); ++v) {
      const ExposedSide &target = surface.sides()[u], &side = surface.sides()[v];
      if (target.triangle == side.triangle || !sound(target, now[u]) || !sound(side, now[v])) continue;
      if (may_touch(now[u], now[v], side.depth_limit, margin)) pairs.push_back({static_cast<int>(u), static_cast<int>(v)});
    }
  return pairs;
}

// Those pairs of which a Gauss point is within the side's mitres and not too deep.
std::vector<SidePair> touching_pairs(const Surface& surface, const std::vector<SideNow>& now) {
  std::vector<SidePair> pairs;
  for (const SidePair& pair : brute_force(surface, now, 0.0)) {
    const SideNow& side = now[static_cast<std::size_t>(pair.side)];
    const Axes a = axes(side);
    const auto touches = [&](double g) {
      const Place p = place_of(point_on(now[static_cast<std::size_t>(pair.target)], g), side, a);
      const double limit = surface.sides()[static_cast<std::size_t>(pair.side)].depth_limit;
      return p.depth > 0.0 && p.depth < limit && p.along > -p.depth && p.along < a.length + p.depth;
    };
    if (std::any_of(point_place.begin(), point_place.end(), touches) && !surface.same_corner(pair.target, pair.side)) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

TEST_CASE("Cells find the pairs that brute force finds") {
  CellSearch cells;
  std::vector<SidePair> found;
  for (std::uint64_t id = 0; id < 30; ++id) {
    Debris debris(id, 60, id % 2 == 0 ? 8.0 * h : 30.0 * h);
    if (id % 3 == 0) debris.triangles.move(3, 1, std::numeric_limits<double>::quiet_NaN(), 0.0);
    if (id % 3 == 1) debris.triangles.move(4, 2, 1e30, -1e6);
    if (id % 5 == 0)
      for (int k = 0; k < 3; ++k) debris.triangles.move(7, k, 1e6, -1e6);
    const Surface surface = debris.surface();
    const std::vector<SideNow> now = places(surface, debris.triangles);
    for (const double margin : {0.0, 0.1 * h}) {
      cells.find({surface.sides(), now, margin}, found);
      CHECK(found == brute_force(surface, now, margin));
      CHECK(found.size() > (id % 2 == 0 ? 20 : 0));
      std::vector<SidePair> grown;
      const std::size_t part = 3 * (60 - 2 * id);  // exposed earlier than the rest
      cells.find({std::span(surface.sides()).first(part), std::span(now).first(part), margin}, grown);
      CellSearch::add({surface.sides(), now, margin}, part, grown);
      CHECK(grown == found);
    }
  }
}

TEST_CASE("The near list holds every touching pair while everything moves, and is seldom made anew") {
  for (std::uint64_t id = 0; id < 5; ++id) {
    Debris debris(id, 60, 10.0 * h);
    RandomStream random(6, id, 1);
    const Surface surface = debris.surface();
    NearPairs near(surface.mean_length());
    std::vector<std::array<double, 2>> drift;
    for (int t = 0; t < 60; ++t) drift.push_back({random.uniform(-1e-6, 1e-6), random.uniform(-1e-6, 1e-6)});
    long touching = 0;
    for (int n = 0; n < 400; ++n) {
      for (int t = 0; t < 60; ++t)
        for (int k = 0; k < 3; ++k)
          debris.triangles.move(t, k, drift[static_cast<std::size_t>(t)][0] + random.uniform(-1e-7, 1e-7),
                                drift[static_cast<std::size_t>(t)][1] + random.uniform(-1e-7, 1e-7));
      near.follow(surface, debris.triangles.displacement.data());
      if (n % 7 != 0) continue;
      const std::vector<SidePair> all = touching_pairs(surface, places(surface, debris.triangles));
      touching += static_cast<long>(all.size());
      CHECK(std::includes(near.pairs().begin(), near.pairs().end(), all.begin(), all.end()));
    }
    CHECK(touching > 1000);
    CHECK(near.searches() > 1);
    CHECK(near.searches() < 20);
    CHECK(near.selections() < 80);
  }
}

TEST_CASE("Everything exposed and everything in one place stay within bounds of work") {
  Triangles<double> triangles;
  add_block(triangles, 0, {0.0, 0.0}, {40 * h, 40 * h}, {40, 40});
  Surface surface(triangles.corners, triangles.neighbour);
  for (std::size_t s = 0; s < triangles.neighbour.size(); ++s) surface.expose({static_cast<int>(s), 0});
  surface.commit();
  NearPairs near(surface.mean_length());
  near.follow(surface, triangles.displacement.data());
  CHECK(near.pairs().size() < 20 * surface.sides().size());
  for (double& u : triangles.displacement) u = 1e30;  // all of them huge, then all of them nothing
  near.follow(surface, triangles.displacement.data());
  CHECK(near.pairs().empty());
  for (std::size_t n = 0; n < triangles.displacement.size(); ++n) triangles.displacement[n] = -triangles.corners[n];
  near.follow(surface, triangles.displacement.data());
  CHECK(near.pairs().empty());
}
