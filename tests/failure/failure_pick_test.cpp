// The running pick against the same criteria on the rows so far, and against every future that keeps what its rule assumes.
#include "common/failure/failure_pick.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "common/failure/failure.hpp"
#include "common/failure/five_step.hpp"
#include "common/failure/peaks.hpp"

using namespace fracfarm;

namespace {

struct Signals {
  std::vector<double> time, stress, energy;

  void add(double s, double e) { time.push_back(1e-6 * static_cast<double>(time.size() + 1)), stress.push_back(s), energy.push_back(e); }
  std::optional<double> pick() const { return five_step(time, stress, energy); }
};

// A pull to `collapse`, then stress and energy ring down; smooth, so that the key peak is the collapse.
Signals collapse_at(int collapse, int rows) {
  Signals s;
  for (int i = 0; i < rows; ++i) {
    const double after = i - collapse, x = static_cast<double>(i) / collapse;
    const double stress = after < 0 ? 5.0 * x : 5.0 * std::cos(after / 12.0) * std::exp(-after / 60.0);
    const double energy = after < 0 ? 2.0 * x * x : 2.0 + 6.0 * std::exp(-std::pow((after - 14.0) / 9.0, 2)) + 0.2 * std::sin(after / 15.0);
    s.add(stress, energy);
  }
  return s;
}

FailurePick fed(const Signals& s, std::size_t rows) {
  FailurePick pick;
  for (std::size_t i = 0; i < rows; ++i) pick.add({s.time[i], s.stress[i], s.stress[i], s.energy[i]});
  return pick;
}

// Small steps, many of them ties, and a jump now and then; from a level that stays in 0 ... 40, of which 2 % are three steps.
double walk(double level, std::mt19937& engine) {
  const double step = 0.25 * (static_cast<double>(engine() % 7) - 3.0), jump = engine() % 10 ? 1.0 : 12.0;
  return std::clamp(level + jump * step, 0.0, 40.0);
}

}  // namespace

TEST_CASE("after every row drop10 is the stress drop of the rows so far, to the bit") {
  std::mt19937 engine(11);
  for (int trial = 0; trial < 30; ++trial) {
    Signals s;
    FailurePick pick;
    double level = 5.0;
    for (int i = 0; i < 200; ++i) {
      level = walk(level, engine);
      s.add(level - 3.0, 0.0);
      pick.add({s.time.back(), s.stress.back(), s.stress.back(), 0.0});
      REQUIRE(pick.drop10() == stress_drop(s.time, s.stress));
    }
  }
}

TEST_CASE("the pick of a running series is that of its rows so far") {
  const Signals s = collapse_at(100, 400);
  for (std::size_t rows : {50u, 120u, 200u, 400u}) {
    Signals cut = s;
    cut.time.resize(rows), cut.stress.resize(rows), cut.energy.resize(rows);
    CHECK(fed(s, rows).five_step() == cut.pick());
  }
}

TEST_CASE("a collapse is settled a quarter of the pick's time after the pick, and stays what it was") {
  const Signals s = collapse_at(100, 800);
  const double pick = s.pick().value();
  const FailurePick running = fed(s, 800);
  REQUIRE(running.settled());
  CHECK(*running.settled_at() >= (1.0 + settling_wait) * pick);
  CHECK(*running.settled_at() <= (1.0 + settling_wait) * pick * 1.05);
  const std::size_t rows = static_cast<std::size_t>(std::lround(*running.settled_at() * 1e6));
  CHECK(fed(s, rows).settled());
  CHECK_FALSE(fed(s, rows - 1).settled());
  CHECK(fed(s, rows).five_step() == pick);
}

TEST_CASE("without a lost stress or without a pick nothing settles") {
  Signals held = collapse_at(100, 800);
  for (double& stress : held.stress) stress += 20.0;
  CHECK(fed(held, 800).five_step());
  CHECK_FALSE(fed(held, 800).settled());
  Signals silent;
  for (int i = 0; i < 800; ++i) silent.add(i < 100 ? i : 0.0, i);
  CHECK(fed(silent, 800).drop10());
  CHECK_FALSE(fed(silent, 800).settled());
}

TEST_CASE("a loud row after the pick starts the wait again") {
  Signals s = collapse_at(100, 800);
  const double before = fed(s, 800).settled_at().value();
  const std::size_t loud = static_cast<std::size_t>(before * 1e6) - 10;
  s.stress[loud] = 0.7 * *std::max_element(s.stress.begin(), s.stress.end());
  const double after = fed(s, 800).settled_at().value();
  CHECK(after >= s.time[loud] + settling_wait * s.pick().value() * 0.999);
}

TEST_CASE("a restart that feeds the rows again settles at the same row") {
  const Signals s = collapse_at(140, 900);
  FailurePick whole = fed(s, 900), resumed = fed(s, 150);
  for (std::size_t i = 150; i < 900; ++i) resumed.add({s.time[i], s.stress[i], s.stress[i], s.energy[i]});
  CHECK(whole.settled_at() == resumed.settled_at());
}

// The exact part of the rule: random walks with many ties; wherever the peaks are firm, no future within the assumptions moves the pick.
TEST_CASE("no future that keeps the range and falls less steeply moves a firm pick") {
  std::mt19937 engine(5);
  int firm = 0, picks = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Signals s;
    const int rows = 62 + static_cast<int>(engine() % 30);
    double stress = 20.0, energy = 0.0;
    for (int i = 0; i < rows; ++i) {  // a range of about 100, of which 2 % are more than the energy moves in a row
      stress = walk(stress, engine), energy += i < 50 ? 2.0 : 0.1 * (static_cast<double>(engine() % 39) - 19.5);
      s.add(stress, energy);
    }
    picks += s.pick().has_value();
    if (!firm_pick(s.time, s.stress, s.energy)) continue;
    ++firm;
    const FiveSteps steps = five_steps(s.time, s.stress, s.energy);
    const auto [low_s, high_s] = std::minmax_element(s.stress.begin(), s.stress.end());
    const auto [low_e, high_e] = std::minmax_element(s.energy.begin(), s.energy.end());
    const double ls = *low_s, hs = *high_s, le = *low_e, he = *high_e, fall = steps.key->drop.rate * 1e-6;
    for (int future = 0; future < 5; ++future) {
      Signals t = s;
      for (int i = 0; i < 40; ++i) {
        const double down = std::uniform_real_distribution<double>(0.0, 0.999)(engine) * fall;
        const double e = engine() % 2 ? t.energy.back() - down : t.energy.back() + static_cast<double>(engine() % 9);
        t.add(std::clamp(t.stress.back() + static_cast<double>(engine() % 9) - 4.0, ls, hs), std::clamp(e, le, he));
      }
      REQUIRE(t.pick() == s.pick());
    }
  }
  INFO(firm << " of " << picks << " picks are firm");
  CHECK(firm > 1000);
  CHECK(firm < picks - 30);
}
