#include "tests/simulation/disk_matrix.hpp"

#include <catch2/catch.hpp>
#include <cstdio>

using namespace fracfarm::simulation;

TEST_CASE("A full, failing, tearing or forgetting disk, at calls all over a campaign, breaks no promise") {
  for (const MatrixRow& row : disk_matrix(37, [](const MatrixRow& it) { std::puts(text_of(it).c_str()); })) {
    INFO(text_of(row));
    CHECK(row.runs > 2);
    CHECK(row.violations == 0);
  }
}
