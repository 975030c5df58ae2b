// Seed paper, eqs 18-22. Slips mended: crack ends may leave the sample (starts keep 0.02 m from the sides, lengths go to 0.05 m), so ends
// are clipped or redrawn.
#include "common/scene/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "common/base/random.hpp"
#include "common/base/text.hpp"

namespace fracfarm {
namespace {

// One Philox stream for each quantity of each set. The numbers are part of every published pattern: add at the end, never renumber.
enum Role : std::uint32_t {
  horizontal_count = 1,
  horizontal_x,
  horizontal_z,
  horizontal_length,
  vertical_count,
  vertical_x,
  vertical_z,
  vertical_length,
  oblique_count,
  oblique_x,
  oblique_z,
  oblique_length,
  oblique_angle,
};

struct Direction {
  double x, z;
};

// cos and sin of theta in [0, pi/2] by their series in a fixed order: a library's sine may differ in its last bit between processors, and
// the bits of a pattern are its identity. Within 2 units in the last place.
Direction direction(double theta) {
  const bool steep = theta > std::numbers::pi / 4;
  const double t = steep ? std::numbers::pi / 2 - theta : theta;
  const double y = t * t;
  double sine = 0.0, cosine = 0.0;
  for (int k = 17; k >= 1; k -= 2) sine = 1 - y / (static_cast<double>(k + 1) * (k + 2)) * sine;
  for (int k = 18; k >= 0; k -= 2) cosine = 1 - y / (static_cast<double>(k + 1) * (k + 2)) * cosine;
  sine *= t;
  return steep ? Direction{sine, cosine} : Direction{cosine, sine};
}

bool inside(const Segment& crack, const PatternSettings& s) {
  return crack.x1 >= 0 && crack.x1 <= s.width && crack.z1 >= 0 && crack.z1 <= s.height;
}

// One set of cracks: its streams, and how a crack points.
class SetDrawer {
 public:
  // Count, x, z, length and, for the oblique set, angle follow each other in Role.
  SetDrawer(std::uint64_t seed, std::uint64_t id, Role first_role, const PatternSettings& settings)
      : settings_(settings),
        count_(seed, id, first_role),
        x_(seed, id, first_role + 1),
        z_(seed, id, first_role + 2),
        length_(seed, id, first_role + 3),
        angle_(seed, id, first_role + 4) {}

  int count(int low, int high) { return count_.integer(low, high); }

  // eqs 18 and 19 with the given direction, or with one of eq. 22.
  void draw(int cracks, const Direction* along, std::vector<Segment>& out) {
    for (int i = 0; i < cracks; ++i) {
      Segment crack = draw_one(along);
      while (settings_.redraw && !inside(crack, settings_)) crack = draw_one(along);
      if (clip(crack, settings_.width, settings_.height)) out.push_back(crack);
    }
  }

 private:
  Segment draw_one(const Direction* along) {
    const double x = x_.uniform(settings_.buffer, settings_.width - settings_.buffer);
    const double z = z_.uniform(settings_.buffer, settings_.height - settings_.buffer);
    const double length = length_.uniform(settings_.length_min, settings_.length_max);
    const Direction d = along ? *along : direction(angle_.uniform(0.0, std::numbers::pi / 2));
    return {.x0 = x, .z0 = z, .x1 = x + length * d.x, .z1 = z + length * d.z};
  }

  const PatternSettings& settings_;
  RandomStream count_, x_, z_, length_, angle_;
};

// Liang-Barsky for one slab: narrows [t0, t1] to where low <= start + t * step <= high.
bool narrow(double start, double step, double low, double high, double& t0, double& t1) {
  if (step == 0.0) return start >= low && start <= high;
  const double a = (low - start) / step, b = (high - start) / step;
  t0 = std::max(t0, std::min(a, b));
  t1 = std::min(t1, std::max(a, b));
  return t0 < t1;
}

}  // namespace

Problems check(const PatternSettings& s) {
  Problems problems;
  const double smaller = std::min(s.width, s.height);
  const auto expect = [&](bool good, std::string_view key, double value, std::string limit) {
    if (!good) problems.push_back({std::string(key), shortest(value), std::move(limit), ""});
  };
  expect(s.buffer >= 0, "pattern.buffer", s.buffer, "at least 0 m");
  expect(smaller > 2 * s.buffer, s.width <= s.height ? "domain.width" : "domain.height", smaller,
         fmt::format("above 2 buffers = {} m, so that cracks can start", shortest(2 * s.buffer)));
  expect(s.length_min > 0 && s.length_min <= s.length_max, "pattern.length_min", s.length_min,
         fmt::format("above 0 and at most length_max = {} m", shortest(s.length_max)));
  expect(s.count_min >= 0 && s.count_min <= s.count_max && s.count_max <= 1000, "pattern.count_max", s.count_max,
         "count_min to 1000, count_min at least 0");
  // Else some crack could be drawn for ever.
  expect(!s.redraw || s.buffer + s.length_max < smaller, "pattern.length_max", s.length_max,
         fmt::format("below {} m while cracks that leave the domain are drawn again", shortest(smaller - s.buffer)));
  return problems;
}

// The paper leaves open whether an oblique model has one orientation or one a crack. Its text says that the fractures of a model are "not
// necessarily orthogonal with one another" and that orientations (plural) are assigned by drawing: theta is drawn for each crack.
std::vector<Segment> draw_pattern(CrackSet set, std::uint64_t campaign_seed, std::uint64_t id, const PatternSettings& settings) {
  assert(check(settings).empty());
  std::vector<Segment> cracks;
  if (set == CrackSet::oblique) {
    SetDrawer oblique(campaign_seed, id, oblique_count, settings);
    oblique.draw(oblique.count(2 * settings.count_min, 2 * settings.count_max), nullptr, cracks);
    return cracks;
  }
  static constexpr Direction right{1.0, 0.0}, up{0.0, 1.0};
  SetDrawer horizontal(campaign_seed, id, horizontal_count, settings);
  horizontal.draw(horizontal.count(settings.count_min, settings.count_max), &right, cracks);
  SetDrawer vertical(campaign_seed, id, vertical_count, settings);
  vertical.draw(vertical.count(settings.count_min, settings.count_max), &up, cracks);
  return cracks;
}

bool clip(Segment& s, double width, double height) {
  const double dx = s.x1 - s.x0, dz = s.z1 - s.z0;
  if (dx == 0.0 && dz == 0.0) return false;
  double t0 = 0.0, t1 = 1.0;
  if (!narrow(s.x0, dx, 0.0, width, t0, t1) || !narrow(s.z0, dz, 0.0, height, t0, t1)) return false;
  // Ends that stay are not touched; an end that moved lies on the side that cut it to the bit, so that clipping again moves nothing.
  const auto coordinate = [](double start, double step, double high, double t) {
    if (step != 0.0 && t == (0.0 - start) / step) return 0.0;
    if (step != 0.0 && t == (high - start) / step) return high;
    return std::clamp(start + t * step, 0.0, high);
  };
  const auto at = [&](double t) { return std::array{coordinate(s.x0, dx, width, t), coordinate(s.z0, dz, height, t)}; };
  const auto [x0, z0] = t0 > 0.0 ? at(t0) : std::array{s.x0, s.z0};
  const auto [x1, z1] = t1 < 1.0 ? at(t1) : std::array{s.x1, s.z1};
  s = {.x0 = x0, .z0 = z0, .x1 = x1, .z1 = z1};
  return x0 != x1 || z0 != z1;
}

const NamedLoad* find_load(std::string_view name) {
  for (const NamedLoad& load : named_loads)
    if (load.name == name) return &load;
  return nullptr;
}

}  // namespace fracfarm
