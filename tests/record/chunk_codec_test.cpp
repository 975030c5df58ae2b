#include "common/record/chunk_codec.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "common/record/rounding.hpp"

using namespace fracfarm;

namespace {

std::string noise(std::size_t size) {
  std::mt19937 engine(7);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(engine() & 0x3f);
  return bytes;
}

}  // namespace

TEST_CASE("fletcher32 of known texts is HDF5's") {
  // Big-endian 16-bit words: values of H5_checksum_fletcher32 of library 1.10.
  CHECK(fletcher32("") == 0u);
  CHECK(fletcher32("abcdef") == ((0x6162u * 3 + 0x6364u * 2 + 0x6566u) % 0xffffu << 16 | (0x6162u + 0x6364u + 0x6566u) % 0xffffu));
  CHECK(fletcher32(std::string(1000, '\xff')) == 0xffffffffu);  // folded, never reduced to zero
}

TEST_CASE("an odd last byte counts as a high byte") { CHECK(fletcher32("a") == 0x61006100u); }

TEST_CASE("chunks come back for every element size") {
  for (std::size_t element : {1u, 4u, 8u}) {
    const std::string raw = noise(4096);
    std::string back(raw.size(), '\0');
    CHECK(decode_chunk(encode_chunk(raw, element), element, back).empty());
    CHECK(back == raw);
  }
}

TEST_CASE("a chunk of another size than expected is refused, larger or smaller") {
  const std::string stored(encode_chunk(noise(4096), 4));
  std::string shorter(4092, '\0'), longer(4100, '\0');
  CHECK_FALSE(decode_chunk(stored, 4, shorter).empty());
  CHECK_FALSE(decode_chunk(stored, 4, longer).empty());
}

TEST_CASE("every flipped bit of a stored chunk is seen") {
  const std::string stored(encode_chunk(noise(256), 4));
  std::string back(256, '\0');
  for (std::size_t bit = 0; bit < stored.size() * 8; ++bit) {
    std::string damaged = stored;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    REQUIRE_FALSE(decode_chunk(damaged, 4, back).empty());
  }
  for (std::size_t size = 0; size < stored.size(); ++size) REQUIRE_FALSE(decode_chunk(stored.substr(0, size), 4, back).empty());
}
