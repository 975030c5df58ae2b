// Random patterns: known answers, the stated distributions over 10,000 patterns, independence, clipping.
#include "common/scene/pattern.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/base/random.hpp"

using namespace fracfarm;

namespace {

constexpr std::uint64_t seed = 2026;
constexpr int patterns = 10'000;

// Starts so far from the sides that nothing is ever clipped: lengths and angles are seen as drawn.
const PatternSettings roomy{.buffer = 0.06};

bool horizontal(const Segment& crack) { return crack.z0 == crack.z1; }
double length(const Segment& c) { return std::hypot(c.x1 - c.x0, c.z1 - c.z0); }

// One number from each crack of 10,000 patterns.
std::vector<double> gather(CrackSet set, const PatternSettings& settings, const std::function<double(const Segment&)>& what) {
  std::vector<double> out;
  for (int id = 1; id <= patterns; ++id)
    for (const Segment& crack : draw_pattern(set, seed, static_cast<std::uint64_t>(id), settings)) out.push_back(what(crack));
  return out;
}

// Kolmogorov-Smirnov statistic times sqrt(n) against the uniform distribution; above 2.23 with probability 1e-4.
double ks_uniform(std::vector<double> values, double low, double high) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = (values[i] - low) / (high - low);
    worst = std::max({worst, static_cast<double>(i + 1) / n - expected, expected - static_cast<double>(i) / n});
  }
  return worst * std::sqrt(n);
}
constexpr double ks_limit = 2.23;

// Chi-square of counts against equal probabilities.
double chi_square(const std::vector<int>& counts) {
  double total = 0.0, sum = 0.0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sa += a[i], sb += b[i], saa += a[i] * a[i], sbb += b[i] * b[i], sab += a[i] * b[i];
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

}  // namespace

// Produced by this code; a second implementation of Philox, eqs 18-22 and the roles, in another language, gave the same bits. Philox itself
// is held to its published known answers in the tests of common/base.
TEST_CASE("orthogonal pattern 1 of seed 2026 is these ten cracks") {
  const std::vector<Segment> expected{
      {0.026194393263425392, 0.05177650516930983, 0.05965293623373978, 0.05177650516930983},
      {0.039381981554813525, 0.21788088223022373, 0.08303565943758234, 0.21788088223022373},
      {0.13474467381661884, 0.19090885998710833, 0.17713013521808524, 0.19090885998710833},
      {0.08191501645922905, 0.19301803166051087, 0.11993802924512403, 0.19301803166051087},
      {0.10239541184092014, 0.07484015997952491, 0.10239541184092014, 0.11419078553584301},
      {0.0729219984086449, 0.18824623352862543, 0.0729219984086449, 0.20213270381556556},
      {0.20014819217213967, 0.12162728670193994, 0.20014819217213967, 0.15700153139330414},
      {0.0652552325211047, 0.13949499809250782, 0.0652552325211047, 0.17512261925082695},
      {0.17616131624013973, 0.10979018800506303, 0.17616131624013973, 0.12395149698118728},
      {0.033717022157897, 0.045006013331956876, 0.033717022157897, 0.05933011274741418},
  };
  CHECK(draw_pattern(CrackSet::orthogonal, seed, 1) == expected);
}

TEST_CASE("oblique pattern 1 of seed 2026 has these first and clipped cracks") {
  const std::vector<Segment> cracks = draw_pattern(CrackSet::oblique, seed, 1);
  REQUIRE(cracks.size() == 30);
  CHECK(cracks[0] == Segment{0.09683095600992316, 0.040349412389643055, 0.11346217580083894, 0.07563042236071793});
  CHECK(cracks[1] == Segment{0.04151125292571352, 0.22151972242667364, 0.043350065842538976, 0.23860493782072872});
  CHECK(cracks[25] == Segment{0.2172982351216771, 0.2285563240544166, 0.2335773179776254, 0.25});
}

TEST_CASE("numbers of horizontal and vertical cracks are uniform on 3 to 15 and independent") {
  std::vector<int> across(13), up(13), joint(169);
  for (int id = 1; id <= patterns; ++id) {
    const auto cracks = draw_pattern(CrackSet::orthogonal, seed, static_cast<std::uint64_t>(id));
    const auto h = static_cast<std::size_t>(std::count_if(cracks.begin(), cracks.end(), horizontal));
    REQUIRE((h >= 3 && h <= 15 && cracks.size() - h >= 3 && cracks.size() - h <= 15));
    ++across[h - 3], ++up[cracks.size() - h - 3], ++joint[(h - 3) * 13 + cracks.size() - h - 3];
  }
  CHECK(chi_square(across) < 39.1);  // 12 degrees of freedom, p = 1e-4
  CHECK(chi_square(up) < 39.1);
  CHECK(chi_square(joint) < 243);  // 168 degrees of freedom, p = 1e-4
}

TEST_CASE("numbers of oblique cracks are uniform on 6 to 30") {
  std::vector<int> counts(25);
  for (int id = 1; id <= patterns; ++id) ++counts.at(draw_pattern(CrackSet::oblique, seed, static_cast<std::uint64_t>(id)).size() - 6);
  CHECK(chi_square(counts) < 58.6);  // 24 degrees of freedom, p = 1e-4
}

TEST_CASE("starts are uniform on the domain less 0.02 m at each side") {
  for (const CrackSet set : {CrackSet::orthogonal, CrackSet::oblique}) {
    CHECK(ks_uniform(gather(set, {}, [](const Segment& c) { return c.x0; }), 0.02, 0.23) < ks_limit);
    CHECK(ks_uniform(gather(set, {}, [](const Segment& c) { return c.z0; }), 0.02, 0.23) < ks_limit);
  }
}

TEST_CASE("lengths are uniform on 0.01 to 0.05 m") {
  for (const CrackSet set : {CrackSet::orthogonal, CrackSet::oblique}) CHECK(ks_uniform(gather(set, roomy, length), 0.01, 0.05) < ks_limit);
}

TEST_CASE("oblique angles are uniform on 0 to 90 degrees, one for each crack") {
  const auto angle = [](const Segment& c) { return std::atan2(c.z1 - c.z0, c.x1 - c.x0); };
  CHECK(ks_uniform(gather(CrackSet::oblique, roomy, angle), 0.0, std::numbers::pi / 2) < ks_limit);
  const auto cracks = draw_pattern(CrackSet::oblique, seed, 1, roomy);
  CHECK(std::abs(angle(cracks[0]) - angle(cracks[1])) > 1e-6);
}

TEST_CASE("x, z and length of a crack do not hang together") {
  const auto x = gather(CrackSet::oblique, roomy, [](const Segment& c) { return c.x0; });
  const auto z = gather(CrackSet::oblique, roomy, [](const Segment& c) { return c.z0; });
  const auto l = gather(CrackSet::oblique, roomy, length);
  const double limit = 4 / std::sqrt(static_cast<double>(x.size()));
  CHECK(std::abs(correlation(x, z)) < limit);
  CHECK(std::abs(correlation(x, l)) < limit);
  CHECK(std::abs(correlation(z, l)) < limit);
}

TEST_CASE("a pattern depends on its own seed and id alone") {
  std::vector<std::vector<Segment>> forward;
  for (std::uint64_t id = 1; id <= 50; ++id) forward.push_back(draw_pattern(CrackSet::orthogonal, seed, id));
  for (std::uint64_t id = 50; id >= 1; --id) CHECK(draw_pattern(CrackSet::orthogonal, seed, id) == forward[id - 1]);
  for (std::size_t i = 1; i < forward.size(); ++i) CHECK(forward[i] != forward[i - 1]);
  CHECK(draw_pattern(CrackSet::orthogonal, seed + 1, 1) != forward[0]);
  CHECK(draw_pattern(CrackSet::orthogonal, seed, (1ull << 32) + 1) != forward[0]);
}

TEST_CASE("fewer cracks are the first of more: a count moves no other draw") {
  const auto many = draw_pattern(CrackSet::oblique, seed, 5, {.buffer = 0.06, .count_min = 10, .count_max = 10});
  const auto few = draw_pattern(CrackSet::oblique, seed, 5, {.buffer = 0.06, .count_min = 2, .count_max = 2});
  CHECK(few == std::vector<Segment>(many.begin(), many.begin() + 4));
}

TEST_CASE("cracks end inside: clipped by default, drawn again on request") {
  int clipped = 0, drawn_again = 0;
  for (std::uint64_t id = 1; id <= 500; ++id) {
    for (const Segment& c : draw_pattern(CrackSet::orthogonal, seed, id)) clipped += c.x1 == 0.25 || c.z1 == 0.25;
    for (const Segment& c : draw_pattern(CrackSet::orthogonal, seed, id, {.redraw = true})) {
      REQUIRE((c.x1 <= 0.25 && c.z1 <= 0.25));
      CHECK(length(c) >= 0.01 - 1e-15);
      drawn_again += c.x1 == 0.25 || c.z1 == 0.25;
    }
  }
  // An end leaves where start + length > 0.25: probability 0.0536 from the two uniform laws, of some 9000 cracks.
  CHECK(clipped > 390);
  CHECK(clipped < 570);
  CHECK(drawn_again == 0);
}

TEST_CASE("settings that no pattern can be drawn with are told apart") {
  CHECK(check({}).empty());
  CHECK(check({.width = 0.04}).at(0).key == "domain.width");
  CHECK(check({.buffer = -1}).at(0).key == "pattern.buffer");
  CHECK(check({.length_min = 0.06}).at(0).key == "pattern.length_min");
  CHECK(check({.count_min = 4, .count_max = 3}).at(0).key == "pattern.count_max");
  CHECK(check({.width = 0.06, .redraw = true}).at(0).key == "pattern.length_max");
  CHECK(check({.width = 0.06}).empty());
}

TEST_CASE("clipping keeps the inner part with its ends on the sides") {
  Segment through{-1, 0.1, 2, 0.1};
  REQUIRE(clip(through, 1.0, 1.0));
  CHECK(through == Segment{0, 0.1, 1, 0.1});
  Segment corner{0.5, 0.5, 1.5, 2.5};
  REQUIRE(clip(corner, 1.0, 1.0));
  CHECK(corner == Segment{0.5, 0.5, 0.75, 1.0});
  Segment inside{0.1, 0.2, 0.3, 0.4};
  REQUIRE(clip(inside, 1.0, 1.0));
  CHECK(inside == Segment{0.1, 0.2, 0.3, 0.4});
}

TEST_CASE("a crack that only touches the domain, misses it or has no length is none") {
  for (Segment none :
       {Segment{1, 0.5, 2, 0.5}, Segment{-1, 0.9, 0.5, 2.9}, Segment{2, 2, 3, 3}, Segment{0.5, 0.5, 0.5, 0.5}, Segment{1, 1, 2, 2}})
    CHECK_FALSE(clip(none, 1.0, 1.0));
}

TEST_CASE("clipping twice changes no bit more, and what is left lies on the line and inside") {
  RandomStream draw(1, 1, 1);
  for (int i = 0; i < 20'000; ++i) {
    const Segment given{draw.uniform(-1, 2), draw.uniform(-1, 2), draw.uniform(-1, 2), draw.uniform(-1, 2)};
    Segment once = given;
    if (!clip(once, 1.0, 0.7)) continue;
    Segment twice = once;
    REQUIRE(clip(twice, 1.0, 0.7));
    REQUIRE(twice == once);
    for (const auto& [x, z] : {std::pair(once.x0, once.z0), std::pair(once.x1, once.z1)}) {
      REQUIRE((x >= 0 && x <= 1 && z >= 0 && z <= 0.7));
      REQUIRE(std::abs((given.x1 - given.x0) * (z - given.z0) - (given.z1 - given.z0) * (x - given.x0)) < 1e-14);
    }
  }
}
