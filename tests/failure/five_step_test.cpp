// Synthetic signals whose pick is known by construction.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "common/failure/failure.hpp"

namespace {

using namespace fracfarm;

struct Run {
  std::vector<double> time, stress, energy;

  // Piecewise linear signals through (sample, value) corners.
  Run(std::size_t samples, const std::vector<std::pair<double, double>>& stress_corners,
      const std::vector<std::pair<double, double>>& energy_corners) {
    for (std::size_t i = 0; i < samples; ++i) {
      time.push_back(1e-6 * static_cast<double>(i));
      stress.push_back(at(stress_corners, static_cast<double>(i)));
      energy.push_back(at(energy_corners, static_cast<double>(i)));
    }
  }
  static double at(const std::vector<std::pair<double, double>>& corners, double x) {
    for (std::size_t k = 1; k < corners.size(); ++k)
      if (x <= corners[k].first) {
        const auto& [xa, ya] = corners[k - 1];
        const auto& [xb, yb] = corners[k];
        return ya + (yb - ya) * (x - xa) / (xb - xa);
      }
    return corners.back().second;
  }
  std::optional<double> pick() const { return five_step(time, stress, energy); }
};

const std::vector<std::pair<double, double>> key_at_40{{0, 0}, {20, 4}, {30, 2}, {40, 10}, {44, 1}, {60, 3}, {80, 1}};

}  // namespace

TEST_CASE("the pick is where the stress stops falling after the first stress peak that follows the key kinetic energy peak") {
  // Stress peaks at 35 (before the key peak at 40), 50 and 70; falls from 50 to 58.
  const Run run(90, {{0, 0}, {35, 9}, {42, 4}, {50, 6}, {58, 1}, {70, 3}, {80, 0}}, key_at_40);
  CHECK(run.pick() == run.time[58]);
}

TEST_CASE("the key peak is the one with the steepest drop, not the highest") {
  // Highest at 20 with a slow fall (0.5 a sample), key at 50 (2.5 a sample): the first stress peak after 50 is at 60, falling to 66.
  const Run run(90, {{0, 0}, {30, 8}, {36, 2}, {60, 5}, {66, 1}, {80, 2}}, {{0, 0}, {20, 12}, {40, 2}, {50, 7}, {52, 2}, {89, 2.5}});
  CHECK(run.pick() == run.time[66]);
}

TEST_CASE("ripples below two percent of the range are not peaks") {
  // A 1 % ripple at 45 on the way down must not be taken for the stress peak after the key peak.
  const Run run(90, {{0, 0}, {35, 10}, {43, 4}, {45, 4.1}, {47, 3}, {60, 5}, {68, 1}, {85, 2}}, key_at_40);
  CHECK(run.pick() == run.time[68]);
}

TEST_CASE("a fall that levels out ends at the first level sample") {
  const Run run(90, {{0, 0}, {35, 9}, {42, 4}, {50, 6}, {58, 1}, {89, 1}}, key_at_40);
  CHECK(run.pick() == run.time[58]);
}

TEST_CASE("there is no pick where a step finds nothing") {
  const std::vector<std::pair<double, double>> rising{{0, 0}, {89, 9}}, two_peaks{{0, 0}, {50, 6}, {58, 1}, {70, 3}};
  CHECK_FALSE(Run(90, two_peaks, rising).pick());                      // no kinetic energy peak
  CHECK_FALSE(Run(90, {{0, 0}, {30, 6}, {89, 1}}, key_at_40).pick());  // no stress peak after the key peak
  CHECK_FALSE(Run(90, {{0, 0}, {50, 6}, {89, 1}}, key_at_40).pick());  // the stress never stops falling
  CHECK_FALSE(five_step({}, {}, {}));
}

TEST_CASE("of two kinetic energy peaks that fall equally fast the first is the key") {
  // Falls of 3 a sample behind 20 and behind 50; stress peaks at 30 and 60, falling to 34 and 66.
  const std::vector<std::pair<double, double>> stress{{0, 0}, {10, 9}, {16, 2}, {30, 6}, {34, 1}, {60, 5}, {66, 2}, {80, 3}};
  Run run(90, stress, {{0, 0}, {20, 8}, {22, 2}, {50, 8}, {52, 2}, {89, 2}});
  std::iota(run.time.begin(), run.time.end(), 0.0);  // so that equal falls are equal to the bit
  CHECK(run.pick() == 34.0);
  run.energy[22] = 1.9, run.energy[52] = 1.8;
  CHECK(run.pick() == 66.0);
}

TEST_CASE("a stress peak at the very row of the key peak does not come after it") {
  const Run run(90, {{0, 0}, {40, 9}, {46, 4}, {50, 6}, {58, 1}, {80, 3}}, key_at_40);
  CHECK(run.pick() == run.time[58]);
}

TEST_CASE("flat tops of both signals count at their middle") {
  // Energy flat over 38...42, key at 40; stress flat over 36...44 is at 40, not after it, the next one flat over 50...54 is.
  const Run run(90, {{0, 0}, {36, 9}, {44, 9}, {47, 4}, {50, 6}, {54, 6}, {60, 1}, {80, 3}},
                {{0, 0}, {20, 4}, {30, 2}, {38, 10}, {42, 10}, {46, 1}, {60, 3}, {80, 1}});
  CHECK(run.pick() == run.time[60]);
}

TEST_CASE("a plateau on the way down ends the fall: the stress has stopped decreasing") {
  const Run run(90, {{0, 0}, {35, 9}, {42, 4}, {50, 6}, {54, 4}, {56, 4}, {62, 1}, {80, 3}}, key_at_40);
  CHECK(run.pick() == run.time[54]);
}

TEST_CASE("the stress peak after the key counts even while the stress is compressive") {
  const Run run(90, {{0, 0}, {35, 9}, {42, -4}, {50, -1}, {58, -3}, {80, 0}}, key_at_40);
  CHECK(run.pick() == run.time[58]);
}

TEST_CASE("noise that turns no slope around at the pick does not move it") {
  const Run clean(400, {{0, 0}, {150, 9}, {190, 4}, {230, 6}, {270, 1}, {285, 4}, {399, 5}},
                  {{0, 0}, {80, 4}, {120, 2}, {180, 10}, {196, 1}, {260, 3}, {399, 1}});
  REQUIRE(clean.pick() == clean.time[270]);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> noise(-0.04, 0.04);  // less than half of any slope at the pick
  for (int trial = 0; trial < 50; ++trial) {
    Run run = clean;
    for (double& stress : run.stress) stress += noise(engine);
    for (double& energy : run.energy) energy += noise(engine);
    CHECK(run.pick() == clean.time[270]);
  }
}

TEST_CASE("units and sampling do not move the pick") {
  Run run(90, {{0, 0}, {35, 9}, {42, 4}, {50, 6}, {58, 1}, {70, 3}, {80, 0}}, key_at_40);
  const double before = run.pick().value();
  for (double& s : run.stress) s *= 4e6;
  for (double& e : run.energy) e *= 0.25;
  CHECK(run.pick() == before);
  for (double& t : run.time) t *= 8.0;
  CHECK(run.pick() == 8.0 * before);
}

TEST_CASE("smooth oscillations give the analytic minimum") {
  // KE = a decaying train of bumps whose second falls steepest; stress = cos with period 64 samples: peak at 192, minimum at 224.
  Run run(400, {{0, 0}, {399, 0}}, {{0, 0}, {399, 0}});
  for (std::size_t i = 0; i < 400; ++i) {
    const double x = static_cast<double>(i);
    run.stress[i] = std::cos(2.0 * M_PI * x / 64.0) * std::exp(-x / 1000.0);
    run.energy[i] = 3.0 * std::exp(-std::pow((x - 60.0) / 30.0, 2)) + 4.0 * std::exp(-std::pow((x - 150.0) / 8.0, 2));
  }
  const double pick = run.pick().value() * 1e6;
  CHECK(std::abs(pick - 224.0) <= 1.0);  // the envelope moves the minimum by less than a sample
}
