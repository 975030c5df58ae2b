// Damaged and forged files. Damage (a flipped bit, a lost block, a cut) must never be accepted with other content; a forged file, sealed
// again after the damage, must never crash, hang or fool the reader either.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <optional>
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
Tally judge_mutants(int mutants, bool reseal, unsigned seed) {
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

// In a child with a time limit, so that a crash or a hang is an answer. Nothing where the child did not end well.
std::optional<Tally> judge_in_child(int mutants, bool reseal, unsigned seed) {
  int ends[2];
  if (::pipe(ends) != 0) return std::nullopt;
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    const Tally tally = judge_mutants(mutants, reseal, seed);
    ::_exit(::write(ends[1], &tally, sizeof tally) == sizeof tally ? 0 : 1);
  }
  ::close(ends[1]);
  Tally tally;
  const bool heard = ::read(ends[0], &tally, sizeof tally) == sizeof tally;
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return heard && status == 0 ? std::optional<Tally>(tally) : std::nullopt;
}

}  // namespace

TEST_CASE("no damaged file is accepted, unless the damage changed nothing") {
  const Tally tally = judge_in_child(1600, false, 1).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 1590);  // a byte replaced by itself harms nothing
}

TEST_CASE("no forged file crashes the reader or is accepted with other content") {
  const Tally tally = judge_in_child(400, true, 2).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 280);  // the others hit unused space between objects, which no checksum covers
}
