#include "common/failure/peaks.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace fracfarm;

TEST_CASE("prominence is the height above the higher of the two surrounding valleys") {
  const std::vector<double> values{0, 5, 2, 9, 3, 4, 1};  // peaks 5 (valley 2), 9 (from 0 and 1), 4 (valley 3)
  const std::vector<Peak> peaks = local_maxima(values);
  REQUIRE(peaks.size() == 3);
  CHECK(peaks[0].index == 1);
  CHECK(peaks[0].prominence == 3.0);
  CHECK(peaks[1].index == 3);
  CHECK(peaks[1].prominence == 8.0);
  CHECK(peaks[2].index == 5);
  CHECK(peaks[2].prominence == 1.0);
}

TEST_CASE("a flat top is one peak at its middle, and ends are none") {
  const std::vector<double> values{7, 1, 3, 3, 3, 2, 8};
  const std::vector<Peak> peaks = local_maxima(values);
  REQUIRE(peaks.size() == 1);
  CHECK(peaks[0].index == 3);
  CHECK(peaks[0].prominence == 1.0);
}

TEST_CASE("a flat top that leads up or ends the signal is no peak") {
  CHECK(local_maxima(std::vector<double>{0, 2, 2, 3}).empty());
  CHECK(local_maxima(std::vector<double>{0, 2, 2}).empty());
  CHECK(local_maxima(std::vector<double>{1}).empty());
  CHECK(local_maxima(std::vector<double>{}).empty());
}

TEST_CASE("equal peaks see past each other to the lowest ground") {
  const std::vector<Peak> peaks = local_maxima(std::vector<double>{0, 4, 1, 4, 0});
  REQUIRE(peaks.size() == 2);
  CHECK(peaks[0].prominence == 4.0);
  CHECK(peaks[1].prominence == 4.0);
}

TEST_CASE("peaks below the asked share of the range are left out, those at it stay") {
  const std::vector<double> values{0, 100, 50, 52, 50, 51, 0};
  CHECK(prominent_peaks(values, 0.02) == std::vector<std::size_t>{1, 3});
  CHECK(prominent_peaks(values, 0.01) == std::vector<std::size_t>{1, 3, 5});
  CHECK(prominent_peaks(std::vector<double>(5, 1.0), 0.02).empty());
}

TEST_CASE("a peak can grow only while no higher ground follows, and only down to the ground before it") {
  const std::vector<Peak> peaks = local_maxima(std::vector<double>{1, 6, 5, 9, 7, 8, 7.5});
  REQUIRE(peaks.size() == 3);
  CHECK(peaks[0].prominence == 1.0);
  CHECK(peaks[0].reach == 1.0);  // 9 follows
  CHECK(peaks[1].prominence == 2.0);
  CHECK(peaks[1].reach == 8.0);
  CHECK(peaks[2].prominence == 0.5);
  CHECK(peaks[2].reach == 1.0);
}

TEST_CASE("as samples are added no prominence shrinks and none passes its reach") {
  std::mt19937 engine(3);
  std::vector<double> values;
  for (int i = 0; i < 300; ++i) values.push_back(static_cast<double>(engine() % 20));
  std::vector<Peak> before;
  for (std::size_t length = 1; length <= values.size(); ++length) {
    const std::vector<Peak> now = local_maxima(std::span(values).first(length));
    REQUIRE(now.size() >= before.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      CHECK((now[i].index == before[i].index && now[i].prominence >= before[i].prominence && now[i].prominence <= before[i].reach));
    before = now;
  }
}
