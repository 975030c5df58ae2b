// Damaged and forged files. Damage (a flipped bit, a lost block, a cut) must never be accepted with other content; a forged file, sealed
// again after the damage, must never crash, hang or fool the reader either.
#include <catch2/catch.hpp>
#include <random>

#include "common/record/check.hpp"
#include "common/record/seal.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_record.hpp"

using namespace fracfarm;

namespace {

constexpr std::size_t block = 4096;

std::string harm(const std::string& sound, std::mt19937& engine) {
  std::string bytes = sound;
  const std::size_t place = engine() % bytes.size();
  switch (engine() % 5) {
    case 0:
      bytes[place] = static_cast<char>(bytes[place] ^ (1 << engine() % 8));
      break;
    case 1:
      bytes[place] = static_cast<char>(engine());
      break;
    case 2:
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(place / block * block), std::min(block, bytes.size() - place / block * block),
                  '\0');
      break;
    case 3:
      for (std::size_t i = place / block * block; i < std::min(bytes.size(), (place / block + 1) * block); ++i)
        bytes[i] = static_cast<char>(engine());
      break;
    case 4:
      bytes.resize(place);
      break;
  }
  return bytes;
}

struct Tally {
  int refused = 0, same_content = 0, other_content = 0;
};

// `reseal`: a liar with a hash function, so that only HDF5's checksums and the grammar are left.
Tally run(int mutants, bool reseal, unsigned seed) {
  const std::string sound = record_bytes(sample::record()).value();
  std::mt19937 engine(seed);
  Tally tally;
  for (int i = 0; i < mutants; ++i) {
    std::string bytes = harm(reseal ? sound.substr(0, sound.size() - seal_size) : sound, engine);
    if (reseal) bytes += seal_of(bytes);
    const CheckedRecord checked = check_record_bytes(bytes);
    if (!checked.passed())
      ++tally.refused;
    else if (record_bytes(*checked.record).value() == sound)
      ++tally.same_content;
    else
      ++tally.other_content;
  }
  return tally;
}

}  // namespace

TEST_CASE("no damaged file is accepted, unless the damage changed nothing") {
  const Tally tally = run(1000, false, 1);
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 990);
}

TEST_CASE("no forged file with damaged content is accepted") {
  const Tally tally = run(1000, true, 2);
  WARN("of 1000 forged files " << tally.refused << " refused, " << tally.same_content << " read back with the same content");
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 700);  // the others: unused space between objects, which no checksum covers
}
