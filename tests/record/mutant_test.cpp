// Damaged and forged files. Damage (a flipped bit, a lost block, a cut) must never be accepted with other content; a forged file, sealed
// again after the damage, must never crash, hang or fool the reader either.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <optional>
#include <random>
#include <span>

#include "common/base/atomic_file.hpp"
#include "common/record/check.hpp"
#include "common/record/hdf5.hpp"
#include "common/record/seal.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

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
Tally judge_mutants(const std::string& sound, int mutants, bool reseal, unsigned seed) {
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
std::optional<Tally> in_child(const std::function<Tally()>& judge) {
  int ends[2];
  if (::pipe(ends) != 0) return std::nullopt;
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    const Tally tally = judge();
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

std::string phase_field_file() { return record_bytes(sample::record()).value(); }
std::string fdem_file() { return record_bytes(sample::fdem_record()).value(); }

// Other numbers in the place of some of a dataset, through HDF5 and so with fitting checksums, and sealed again.
std::string with_numbers(const std::string& sound, const char* path, std::mt19937& engine) {
  const test::TemporaryFolder folder;
  const auto file_path = folder.path() / "record.h5";
  if (!write_unsynced(file_path, sound.substr(0, sound.size() - seal_size))) return {};
  {
    const h5::Silence silence;
    const h5::Handle file = h5::file(H5Fopen(file_path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    const h5::Handle set = h5::dataset(H5Dopen2(file, path, H5P_DEFAULT));
    const h5::Handle kind = h5::type(H5Dget_type(set)), space = h5::space(H5Dget_space(set));
    std::string bytes(H5Tget_size(kind) * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), '\0');
    H5Dread(set, kind, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
    for (std::size_t k = engine() % 3 + 1; k > 0; --k) {
      const std::size_t element = engine() % (bytes.size() / H5Tget_size(kind)) * H5Tget_size(kind);
      const bool anything = engine() % 2;  // else another number of the same dataset
      const std::size_t other = engine() % (bytes.size() / H5Tget_size(kind)) * H5Tget_size(kind);
      for (std::size_t b = 0; b < H5Tget_size(kind); ++b) bytes[element + b] = anything ? static_cast<char>(engine()) : bytes[other + b];
    }
    H5Dwrite(set, kind, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  }
  const std::string changed = read_file(file_path, 1 << 30).value();
  return changed + seal_of(changed);
}

// A forger who writes through HDF5: what is accepted must be a record that reads, is written and reads again as it is.
Tally judge_forgeries(const std::string& sound, std::span<const char* const> paths, int each, unsigned seed) {
  std::mt19937 engine(seed);
  Tally tally;
  for (const char* path : paths)
    for (int i = 0; i < each; ++i) {
      const CheckedRecord checked = check_record_bytes(with_numbers(sound, path, engine));
      if (!checked.passed())
        ++tally.refused;
      else
        ++(record_bytes(*checked.record).value() == sound ? tally.same_content : tally.other_content);
    }
  return tally;
}

}  // namespace

TEST_CASE("no damaged file is accepted, unless the damage changed nothing") {
  const Tally tally = in_child([] { return judge_mutants(phase_field_file(), 1600, false, 1); }).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 1590);  // a byte replaced by itself harms nothing
}

TEST_CASE("no forged file crashes the reader or is accepted with other content") {
  const Tally tally = in_child([] { return judge_mutants(phase_field_file(), 400, true, 2); }).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 280);  // the others hit unused space between objects, which no checksum covers
}

TEST_CASE("no damaged FDEM file is accepted, unless the damage changed nothing") {
  const Tally tally = in_child([] { return judge_mutants(fdem_file(), 1600, false, 3); }).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 1590);
}

TEST_CASE("no forged FDEM file crashes the reader or is accepted with other content") {
  const Tally tally = in_child([] { return judge_mutants(fdem_file(), 600, true, 4); }).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 420);
}

TEST_CASE("numbers forged into a mesh never crash the reader, and none that contradict the rest are accepted") {
  static constexpr std::array<const char*, 5> of_mesh{"/tri_nodes", "/edge_nodes", "/edge_tris", "/edge_kind", "/edge"};
  const Tally tally = in_child([] { return judge_forgeries(fdem_file(), of_mesh, 40, 5); }).value();
  INFO("refused " << tally.refused << ", same content " << tally.same_content << ", other content " << tally.other_content);
  CHECK(tally.other_content == 0);
  CHECK(tally.refused > 190);
  // Nodes may be moved a little and times of a break within a frame: what is changed so is another sound record.
  static constexpr std::array<const char*, 6> of_frames{"/node_xyz",       "/damage",     "/damage_initial",
                                                        "/damage_failure", "/break_time", "/break_mode"};
  CHECK(in_child([] { return judge_forgeries(fdem_file(), of_frames, 20, 6); }).value().refused > 0);
}
