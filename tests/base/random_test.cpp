#include "common/base/random.hpp"

#include <catch2/catch.hpp>

#include <array>

using fracfarm::RandomStream;

// Known answer of Random123 1.14 (kat_vectors): philox4x32-10, counter and key all zero gives 6627e8d5 e169c58d bc57ac4c 9b00dbd8.
TEST_CASE("the first block of the zero stream is Philox's published known answer") {
  RandomStream stream(0, 0, 0);
  CHECK(stream.bits() == 0xe169c58d6627e8d5ull);
  CHECK(stream.bits() == 0x9b00dbd8bc57ac4cull);
}

TEST_CASE("streams with another seed, id or role differ from the first draw on") {
  const auto first = [](std::uint64_t seed, std::uint64_t id, std::uint32_t role) { return RandomStream(seed, id, role).bits(); };
  CHECK(first(1, 1, 1) != first(2, 1, 1));
  CHECK(first(1, 1, 1) != first(1, 2, 1));
  CHECK(first(1, 1, 1) != first(1, 1, 2));
  CHECK(first(1ull << 40, 1, 1) != first(0, 1, 1));
}

TEST_CASE("uniform numbers fill [0,1) evenly and integers hit both ends") {
  RandomStream stream(7, 3, 0);
  std::array<int, 10> bins{};
  for (int n = 0; n < 100000; ++n) {
    const double u = stream.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    ++bins[static_cast<std::size_t>(u * 10)];
  }
  for (int count : bins) CHECK(count == Approx(10000).margin(400));  // 4 sigma
  std::array<int, 3> faces{};
  for (int n = 0; n < 30000; ++n) ++faces[static_cast<std::size_t>(stream.integer(3, 5) - 3)];
  for (int count : faces) CHECK(count == Approx(10000).margin(400));
}
